#include "io/static_map.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "io/whole_file.h"

namespace donex {
namespace {

namespace fs = std::filesystem;

/// The header of a PCD; padded, so that it can be written over once the number of points is known.
std::string header(std::size_t points, const Eigen::Vector3d& origin) {
  return fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\n# origin {1} {2} {3}\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F "
      "F F\nCOUNT 1 1 1\n"
      "WIDTH {0:<20}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {0:<20}\nDATA binary\n",
      points, origin.x(), origin.y(), origin.z());
}

/// Where a drive is far from the odometry frame's origin, as in UTM, whole kilometres near its first point.
Eigen::Vector3d originNear(const Eigen::Vector3d& first) {
  constexpr double kFar = 10000.0;  // [m] float32 knows places so far away to a millimetre
  constexpr double kStep = 1000.0;
  if (first.cwiseAbs().maxCoeff() < kFar) return Eigen::Vector3d::Zero();
  return (first / kStep).array().round() * kStep;
}

}  // namespace

StaticMap::StaticMap(fs::path file, double voxel_size, std::size_t memory_limit)
    : file_(std::move(file)), voxel_size_(voxel_size), memory_limit_(memory_limit) {}

StaticMap::~StaticMap() { removePutAway(); }

void StaticMap::removePutAway() {
  std::error_code ignored;
  for (const auto& tile : put_away_) fs::remove(fileOf(tile.first), ignored);
  put_away_.clear();
}

fs::path StaticMap::fileOf(const TileIndex& index) const {
  return fmt::format("{}.{}.{}_{}.part", file_.string(), getpid(), index.first, index.second);
}

void StaticMap::add(const Eigen::Vector3d& in_odom) {
  if (!origin_) origin_ = originNear(in_odom);
  const Eigen::Vector3d point = in_odom - *origin_;
  const Eigen::Array3d in_voxels = (point / voxel_size_).array().floor();
  const Index3 voxel = in_voxels.cast<int>();
  const Eigen::Array2d in_tiles = (point.head<2>() / kTile).array().floor();
  const TileIndex tile(static_cast<int>(in_tiles.x()), static_cast<int>(in_tiles.y()));
  const auto [mean, is_new] = tiles_[tile].try_emplace(keyOf(voxel));
  mean->second.sum += (point - (in_voxels * voxel_size_).matrix()).cast<float>();
  ++mean->second.count;
  voxels_ += is_new ? 1U : 0U;
}

void StaticMap::settle(const Eigen::Vector3d& vehicle) {
  if (memoryBytes() <= memory_limit_) return;
  std::vector<std::pair<double, TileIndex>> farthest_first;
  for (const auto& [index, tile] : tiles_) {
    const Eigen::Vector2d center((index.first + 0.5) * kTile, (index.second + 0.5) * kTile);
    farthest_first.emplace_back(-(center - (vehicle - origin()).head<2>()).norm(), index);
  }
  std::sort(farthest_first.begin(), farthest_first.end());
  // Half of it, so that this does not happen in every scan.
  for (const auto& entry : farthest_first) {
    if (memoryBytes() <= memory_limit_ / 2) return;
    putAway(entry.second);
  }
}

void StaticMap::putAway(const TileIndex& index) {
  const auto tile = tiles_.find(index);
  std::ofstream stream(fileOf(index),
                       std::ios::binary | (put_away_.count(index) != 0 ? std::ios::app : std::ios::trunc));
  for (const auto& [key, mean] : tile->second) {
    stream.write(reinterpret_cast<const char*>(&key), sizeof(key));
    stream.write(reinterpret_cast<const char*>(mean.sum.data()), 3 * sizeof(float));
    stream.write(reinterpret_cast<const char*>(&mean.count), sizeof(mean.count));
  }
  stream.close();
  put_away_[index] += tile->second.size();
  if (!stream) throw DataError(fileOf(index).string() + ": cannot be written");
  voxels_ -= tile->second.size();
  tiles_.erase(tile);
}

void StaticMap::takeBack(const TileIndex& index, Tile& tile) const {
  std::ifstream stream(fileOf(index), std::ios::binary);
  for (std::size_t i = 0; i < put_away_.at(index); ++i) {
    VoxelKey key = 0;
    Mean read;
    stream.read(reinterpret_cast<char*>(&key), sizeof(key));
    stream.read(reinterpret_cast<char*>(read.sum.data()), 3 * sizeof(float));
    stream.read(reinterpret_cast<char*>(&read.count), sizeof(read.count));
    if (!stream) throw DataError(fileOf(index).string() + ": voxels that were put away here are gone");
    Mean& mean = tile[key];
    mean.sum += read.sum;
    mean.count += read.count;
  }
}

/// In the order of the keys: the same map is the same file.
std::size_t StaticMap::writeTile(const TileIndex& index, const Tile& tile, std::ostream& stream) const {
  const Eigen::Array3d corner_of_tile(index.first * kTile, index.second * kTile, 0.0);
  const Index3 near = (corner_of_tile / voxel_size_).floor().cast<int>();
  std::vector<VoxelKey> keys;
  for (const auto& entry : tile) keys.push_back(entry.first);
  std::sort(keys.begin(), keys.end());
  for (const VoxelKey key : keys) {
    const Mean& mean = tile.at(key);
    const Eigen::Vector3d corner = voxelOfKey(key, near).cast<double>() * voxel_size_;
    const Eigen::Vector3f point = (corner + (mean.sum / static_cast<float>(mean.count)).cast<double>()).cast<float>();
    stream.write(reinterpret_cast<const char*>(point.data()), 3 * sizeof(float));
  }
  return keys.size();
}

std::size_t StaticMap::write() {
  WholeFile whole(file_);
  whole.stream() << header(0, origin());
  std::size_t points = 0;
  for (const auto& entry : put_away_) tiles_[entry.first];
  while (!tiles_.empty()) {
    const auto tile = tiles_.begin();
    if (put_away_.count(tile->first) != 0) takeBack(tile->first, tile->second);
    points += writeTile(tile->first, tile->second, whole.stream());
    tiles_.erase(tile);
  }
  voxels_ = 0;
  whole.stream().seekp(0);
  whole.stream() << header(points, origin());
  whole.commit();
  removePutAway();
  return points;
}

}  // namespace donex
