// Any bytes as a PointCloud2: judged, read and labelled, or a reason why not; every cloud is accounted for.
#include <array>
#include <cstdlib>
#include <cstring>

#include <boost/make_shared.hpp>
#include <tf2/buffer_core.h>

#include "ros/pipeline.h"

namespace {

using donex::Config;
using donex::Pipeline;
using sensor_msgs::PointCloud2;

/// Takes numbers from the front of the input; zero behind its end.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : at_(data), left_(size) {}

  template <class Number>
  Number take() {
    Number number{};
    const std::size_t taken = std::min(left_, sizeof number);
    if (taken != 0) std::memcpy(&number, at_, taken);
    at_ += taken;
    left_ -= taken;
    return number;
  }
  std::vector<std::uint8_t> rest() const { return {at_, at_ + left_}; }

 private:
  const std::uint8_t* at_;
  std::size_t left_;
};

sensor_msgs::PointCloud2Ptr cloudOf(Bytes bytes) {
  constexpr std::array<const char*, 10> kNames{"x",           "y",         "z",       "time",     "t",
                                               "offset_time", "timestamp", "dynamic", "observed", "intensity"};
  auto cloud = boost::make_shared<PointCloud2>();
  cloud->header.frame_id = "lidar";
  cloud->header.stamp.sec = 100;
  cloud->width = bytes.take<std::uint32_t>();
  cloud->height = bytes.take<std::uint32_t>();
  cloud->point_step = bytes.take<std::uint32_t>();
  cloud->row_step = bytes.take<std::uint32_t>();
  cloud->is_bigendian = bytes.take<std::uint8_t>();
  cloud->fields.resize(bytes.take<std::uint8_t>() % 12);
  for (sensor_msgs::PointField& field : cloud->fields) {
    field.name = kNames[bytes.take<std::uint8_t>() % kNames.size()];
    field.datatype = bytes.take<std::uint8_t>();
    field.offset = bytes.take<std::uint32_t>();
    field.count = bytes.take<std::uint8_t>();
  }
  cloud->data = bytes.rest();
  return cloud;
}

void label(const donex::LabeledScan& scan) {
  const auto out = donex::labelCloud(*scan.cloud, scan.layout, scan.labels);
  const auto moving = donex::selectPart(*scan.cloud, scan.layout, scan.labels, donex::CloudPart::kDynamic);
  const auto still = donex::selectPart(*scan.cloud, scan.layout, scan.labels, donex::CloudPart::kStatic);
  if (moving->width + still->width != scan.layout.echoes()) std::abort();
  if (out->data.size() != scan.layout.echoes() * scan.layout.labeled_point_step) std::abort();
}

Config configOf() {
  Config config;
  config.region = {-5.0, 5.0, -5.0, 5.0, -2.0, 2.0};
  config.voxel_size = 0.5;
  return config;
}

nav_msgs::Odometry odometryAt(double stamp) {
  nav_msgs::Odometry odometry;
  odometry.header.frame_id = "odom";
  odometry.child_frame_id = "lidar";
  odometry.header.stamp.fromSec(stamp);
  odometry.pose.pose.orientation.w = 1.0;
  return odometry;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  tf2::BufferCore tf;
  donex::PipelineEvents events;
  events.labeled = label;
  events.dropped = [](donex::DropReason reason, const std::string&) {
    if (reason == donex::DropReason::kInternalError) std::abort();
  };
  events.refused = [](donex::OdometryRefusal, const std::string&) {};
  events.forgotten = events.strange_times = [](const std::string&) {};
  Pipeline pipeline(configOf(), tf, events);
  for (int i = 0; i < 40; ++i) pipeline.addOdometry(odometryAt(98.0 + 0.1 * i));
  pipeline.addCloud(cloudOf({data, size}), 100.0);
  pipeline.finish();
  const auto& counts = pipeline.counts();
  if (counts.clouds_labeled + counts.dropped.total() != 1) std::abort();
  return 0;
}
