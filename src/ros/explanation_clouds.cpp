#include "ros/explanation_clouds.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "ros/cloud_fields.h"

namespace donex {
namespace {

using sensor_msgs::PointField;

struct Row {
  float x, y, z;
  std::uint32_t rgb;
  std::uint8_t reason, proof;
  std::array<std::uint8_t, 2> padding;
};
static_assert(sizeof(Row) == 20, "the fields below count on it");

sensor_msgs::PointCloud2Ptr cloudOfPlaces(const std_msgs::Header& header, std::size_t points, std::size_t point_step) {
  auto cloud = makeCloud(header, points, point_step);
  addField(*cloud, "x", 0, PointField::FLOAT32);
  addField(*cloud, "y", 4, PointField::FLOAT32);
  addField(*cloud, "z", 8, PointField::FLOAT32);
  return cloud;
}

std::uint32_t packed(std::uint32_t red, std::uint32_t green, std::uint32_t blue) {
  return red << 16U | green << 8U | blue;
}

/// Dark at the wheels, light from `kLightest` upwards.
std::uint32_t greyByHeight(float height) {
  constexpr float kDarkest = -1.0F, kLightest = 5.0F;  // [m]
  const float share = std::clamp((height - kDarkest) / (kLightest - kDarkest), 0.0F, 1.0F);
  const auto grey = static_cast<std::uint32_t>(90.0F + 140.0F * share);
  return packed(grey, grey, grey);
}

std::uint32_t colourOf(EchoReason reason, float height) {
  switch (reason) {
    case EchoReason::kMoving: return packed(255, 0, 255);
    case EchoReason::kNewAlone: return packed(255, 140, 0);
    case EchoReason::kUnobserved: return packed(45, 60, 110);
    case EchoReason::kOutside:
    case EchoReason::kNoEcho: return packed(40, 40, 40);
    case EchoReason::kOwnBody:
    case EchoReason::kLoose:
    case EchoReason::kGround:
    case EchoReason::kSettled: break;
  }
  return greyByHeight(height);
}

}  // namespace

sensor_msgs::PointCloud2Ptr explainScan(const LabeledScan& scan) {
  std::vector<Eigen::Vector3f> positions;  // as they came: the scan's own are de-skewed, and may have another origin
  parseEchoes(*scan.cloud, scan.layout, positions);
  const std::vector<EchoReason> reasons = scan.detector.reasons();
  const std::vector<Proof> proofs = scan.detector.proofs();
  const bool tells = reasons.size() == positions.size(), proves = proofs.size() == positions.size();
  const Eigen::Isometry3f base_from_sensor = scan.scan.base_from_sensor.cast<float>();
  auto cloud = cloudOfPlaces(scan.cloud->header, positions.size(), sizeof(Row));
  addField(*cloud, "rgb", offsetof(Row, rgb), PointField::FLOAT32);
  addField(*cloud, "reason", offsetof(Row, reason), PointField::UINT8);
  addField(*cloud, "proof", offsetof(Row, proof), PointField::UINT8);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const EchoReason by_label = scan.labels.dynamic[i] != 0 ? EchoReason::kMoving : EchoReason::kSettled;
    const EchoReason reason = tells ? reasons[i] : by_label;
    const Eigen::Vector3f& p = positions[i];
    const Proof proof = proves ? proofs[i] : Proof::kNone;
    const std::uint32_t rgb = colourOf(reason, (base_from_sensor * p).z());
    const Row row{p.x(), p.y(), p.z(), rgb, static_cast<std::uint8_t>(reason), static_cast<std::uint8_t>(proof), {}};
    std::memcpy(cloud->data.data() + i * sizeof(Row), &row, sizeof(Row));
  }
  return cloud;
}

sensor_msgs::PointCloud2Ptr cellCloud(const std::vector<Eigen::Vector3f>& centers, const std_msgs::Header& header) {
  auto cloud = cloudOfPlaces(header, centers.size(), sizeof(Eigen::Vector3f));
  if (!centers.empty()) std::memcpy(cloud->data.data(), centers.front().data(), cloud->data.size());
  return cloud;
}

}  // namespace donex
