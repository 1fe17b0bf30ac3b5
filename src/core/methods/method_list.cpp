// Every method by its name.
#include "core/methods/method_list.h"

#include <array>

#include "core/methods/detectors.h"
#include "core/methods/people_remover.h"

namespace donex {
namespace {

constexpr const char* kDonexPaper = "Stralau & Fu, DONEX";

std::unique_ptr<Detector> makeDonex3d(const Config& config) {
  return config.isPaper() ? makePaperDetector3d(config) : makeEvidenceDetector3d(config);
}
double donexBytes3d(const Config& config, double echoes) {
  return config.isPaper() ? paperBytes3d(config, echoes) : evidenceBytes(config, echoes);
}
std::unique_ptr<Detector> makeDonex2d(const Config& config) {
  return config.isPaper() ? makePaperDetector2d(config) : makeEvidenceDetector2d(config);
}
double donexBytes2d(const Config& config, double echoes) {
  return config.isPaper() ? paperBytes2d(config, echoes) : evidenceBytes(config, echoes);
}
std::unique_ptr<WholeDriveDetector> makeUsualPeopleRemover(const Config& config) {
  return makePeopleRemover(config, PeopleRemoverOptions());
}
/// Of methods whose memory follows from the echoes, not from the region.
double noGridBytes(const Config&, double) { return 0.0; }

constexpr MethodEntry live(Method method, MethodKind kind, const char* name, const char* what, const char* source,
                           std::unique_ptr<Detector> (*make)(const Config&), MethodEntry::Bytes bytes) {
  return {{method, kind, name, what, source, false}, make, nullptr, bytes};
}
constexpr MethodEntry wholeDrive(Method method, const char* name, const char* what, const char* source,
                                 std::unique_ptr<WholeDriveDetector> (*make)(const Config&), MethodEntry::Bytes bytes) {
  return {{method, MethodKind::kComparison, name, what, source, true}, nullptr, make, bytes};
}

constexpr std::array kMethods{
    live(Method::kDonex3d, MethodKind::kDonex, "donex_3d", "3D grid with evidence and objects: the default",
         kDonexPaper, makeDonex3d, donexBytes3d),
    live(Method::kDonex2d, MethodKind::kDonex, "donex_2d", "2D grid with evidence and objects", kDonexPaper,
         makeDonex2d, donexBytes2d),
    live(Method::kDonex3dZBuffer, MethodKind::kPaper, "donex_3d_zbuffer",
         "the paper's 3D rule; see-through is read from an image of nearest ranges instead of the traversal",
         "Hu & Li 2012, set aside by the paper", makeZBufferDetector, paperBytes3d),
    live(Method::kMotionVoxelGrid, MethodKind::kComparison, "motion_voxel_grid",
         "ground planes by region; voxels with two counters over the last scans: how often occupied, how often seen "
         "free. Where the logarithm of their ratio is above a threshold, the voxel moves",
         "Asvadi, Premebida, Peixoto & Nunes, \"3D Lidar-based static and moving obstacle detection in driving "
         "environments\", Robotics and Autonomous Systems 83 (2016)",
         makeMotionVoxelGridDetector, noGridBytes),
    live(Method::kRayTracing, MethodKind::kComparison, "ray_tracing",
         "an echo is looked up in the mesh of an earlier scan: on its surface static, before it dynamic, with a "
         "probability; earlier scans are combined by Dempster's rule where the newest leaves it unknown",
         "Lee, Kim & Jo, \"Rapid Motion Segmentation of LiDAR Point Cloud Based on a Combination of Probabilistic and "
         "Evidential Approaches\", Sensors 19 (2019)",
         makeRayTracingDetector, noGridBytes),
    live(Method::kRangeResidual, MethodKind::kComparison, "range_residual",
         "the residual image that learned methods start from, without learning: the relative difference of range to "
         "the scan before, against a threshold",
         "Chen et al., \"Moving Object Segmentation in 3D LiDAR Data\", RA-L 2021", makeRangeResidualDetector,
         noGridBytes),
    wholeDrive(Method::kPeopleremover, "peopleremover",
               "voxels that any line of sight of the whole drive sees through are dynamic; point shadows, clusters, "
               "sub-voxel accuracy",
               "Schauer & Nüchter, \"The Peopleremover\", RA-L 2018", makeUsualPeopleRemover, peopleRemoverBytes),
};

constexpr bool isInOrder() {
  for (std::size_t i = 0; i < kMethods.size(); ++i) {
    if (kMethods[i].info.method != static_cast<Method>(i)) return false;
  }
  return true;
}
static_assert(isInOrder(), "a row per enumerator of Method, in the same order");

template <class Value, class Get>
std::vector<Value> ofAll(Get get) {
  std::vector<Value> values;
  for (const MethodEntry& entry : kMethods) values.push_back(get(entry.info));
  return values;
}

}  // namespace

const MethodEntry& entryOf(Method method) { return kMethods.at(static_cast<std::size_t>(method)); }

const MethodInfo& infoOf(Method method) { return entryOf(method).info; }

const std::vector<Method>& allMethods() {
  static const auto methods = ofAll<Method>([](const MethodInfo& info) { return info.method; });
  return methods;
}

const std::vector<std::string>& namesOf(Method) {
  static const auto names = ofAll<std::string>([](const MethodInfo& info) { return info.name; });
  return names;
}

}  // namespace donex
