#include "evaluation/drift.h"

#include <cmath>
#include <stdexcept>

namespace donex {

Drift driftOver(const std::vector<Eigen::Isometry3d>& estimated, const std::vector<Eigen::Isometry3d>& reference,
                double length) {
  if (estimated.size() != reference.size()) throw std::invalid_argument("drift: two poses for each scan are needed");
  Drift drift;
  drift.length = length;
  for (std::size_t first = 0; first < reference.size(); ++first) {
    double way = 0.0;
    std::size_t last = first;
    while (last + 1 < reference.size() && way < length) {
      ++last;
      way += (reference[last].translation() - reference[last - 1].translation()).norm();
    }
    if (way < length) break;
    const Eigen::Isometry3d truth = reference[first].inverse() * reference[last];
    const Eigen::Isometry3d error = truth.inverse() * (estimated[first].inverse() * estimated[last]);
    drift.translation += error.translation().norm() / way;
    drift.rotation += std::abs(Eigen::AngleAxisd(Eigen::Matrix3d(error.linear())).angle());
    ++drift.pieces;
  }
  if (drift.pieces == 0) return drift;
  drift.translation /= static_cast<double>(drift.pieces);
  drift.rotation /= static_cast<double>(drift.pieces);
  return drift;
}

}  // namespace donex
