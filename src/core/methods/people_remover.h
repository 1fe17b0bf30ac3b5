// Peopleremover: all that a line of sight of the whole drive sees through is dynamic.
#pragma once

#include "donex/whole_drive.h"

namespace donex {

/// J. Schauer and A. Nuechter, "The Peopleremover: Removing Dynamic Objects From 3-D Point Cloud Data by Traversing a
/// Voxel Occupancy Grid", RA-L 2018, and "Removing non-static objects from 3D laser scan data", ISPRS 2018.
struct PeopleRemoverOptions {
  /// Scans this many before and after one are taken as one view with it: what they hit, its lines of sight don't free.
  int diff = 0;
  bool point_shadows = true;  ///< the remedy against false positives near surfaces
  double fuzz = 0.0;          ///< how far echoes of a plane may lie from it [m]
  int min_cluster = 5;        ///< fewer free voxels that touch are noise
  bool subvoxel = true;       ///< echoes of the same scans next to free voxels are dynamic, too
};

/// The definition, over scans 0 to n - 1 and the voxels of the odometry frame:
///  1. Echoes inside the region and farther from the sensor than a voxel's diagonal hit their voxels.
///  2. Every such line of sight, and those to echoes outside the region, is followed from the sensor over the voxels
///     up to where its point shadow lets it go, the last voxel included. It ends at the first voxel that its own scan,
///     or one at most `diff` scans away, has hit; hit voxels it passed before are free.
///  3. Clusters of fewer than `min_cluster` free voxels (26 neighbours) are free no more.
///  4. An echo is dynamic in a free voxel, and in a voxel up to two away from a free one that its scan has hit.
/// `voxel_size` and region are the configuration's. Throws std::invalid_argument for a faulty one.
std::unique_ptr<WholeDriveDetector> makePeopleRemover(const Config& config, const PeopleRemoverOptions& options);

/// What its window takes [bytes], see memoryBound; the voxels of the drive come on top.
double peopleRemoverBytes(const Config& config, double echoes);

}  // namespace donex
