#include "ros/scan_publisher.h"

#include "ros/explanation_clouds.h"
#include "ros/object_messages.h"

namespace donex {
namespace {

using sensor_msgs::PointCloud2;

constexpr std::uint32_t kQueue = 5;  // messages that wait for a slow listener

/// The same of labels, which nobody is to miss: a turn in forty parts, judged while the listener was busy.
constexpr std::uint32_t kLabelQueue = 50;

bool isHeard(const ros::Publisher& publisher) { return publisher.getNumSubscribers() != 0; }

}  // namespace

ScanPublisher::ScanPublisher(ros::NodeHandle pnh)
    : labeled_(pnh.advertise<PointCloud2>("labeled_points", kLabelQueue)),
      dynamic_(pnh.advertise<PointCloud2>("dynamic_points", kQueue)),
      static_(pnh.advertise<PointCloud2>("static_points", kQueue)),
      objects_(pnh.advertise<MovingObjects>("objects", kQueue)),
      markers_(pnh.advertise<visualization_msgs::MarkerArray>("markers", kQueue)),
      explained_(pnh.advertise<PointCloud2>("explained_points", kQueue)),
      shadowed_(pnh.advertise<PointCloud2>("shadowed_cells", kQueue)),
      seen_through_(pnh.advertise<PointCloud2>("seen_through_cells", kQueue)) {}

void ScanPublisher::publishLabels(const LabeledScan& scan) const {
  labeled_.publish(labelCloud(*scan.cloud, scan.layout, scan.labels));
}

void ScanPublisher::publishTheRest(const LabeledScan& scan, const Config& config) {
  if (isHeard(dynamic_)) dynamic_.publish(selectPart(*scan.cloud, scan.layout, scan.labels, CloudPart::kDynamic));
  if (isHeard(static_)) static_.publish(selectPart(*scan.cloud, scan.layout, scan.labels, CloudPart::kStatic));
  const ros::Time& stamp = scan.cloud->header.stamp;
  if (isHeard(objects_)) objects_.publish(toMessage(scan.detector, stamp, scan.odom_frame, scan.odom_from_world));
  if (isHeard(markers_)) {
    const auto array = maker_.make(scan.detector, config, stamp, scan.odom_frame, scan.odom_from_world);
    if (!array->markers.empty()) markers_.publish(array);
  }
  if (isHeard(explained_)) explained_.publish(explainScan(scan));
  if (somebodyWatchesCells()) publishCells(scan);
}

void ScanPublisher::clearMarkers() {
  if (isHeard(markers_)) markers_.publish(maker_.clear());
}

bool ScanPublisher::somebodyWatchesCells() const { return isHeard(shadowed_) || isHeard(seen_through_); }

void ScanPublisher::publishCells(const LabeledScan& scan) const {
  std_msgs::Header header = scan.cloud->header;
  header.frame_id = scan.odom_frame;
  MemoryCells cells = scan.detector.memoryCells();
  for (auto* centers : {&cells.shadowed, &cells.seen_through}) moveEchoes(scan.odom_from_world, *centers);
  shadowed_.publish(cellCloud(cells.shadowed, header));
  seen_through_.publish(cellCloud(cells.seen_through, header));
}

}  // namespace donex
