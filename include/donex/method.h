// The methods: DONEX in its forms, and the systems it is compared with.
#pragma once

#include <string>
#include <vector>

namespace donex {

/// Each has a row in the table of src/core/methods/method_list.cpp, in this order: all else follows from that.
enum class Method {
  kDonex3d,
  kDonex2d,
  kDonex3dZBuffer,
  kMotionVoxelGrid,
  kRayTracing,
  kRangeResidual,
  kPeopleremover,
};

enum class MethodKind {
  kDonex,       ///< the paper's rule with those steps beyond it that the configuration switches on
  kPaper,       ///< the paper's rule alone, whatever the configuration switches on
  kComparison,  ///< a system that DONEX is compared with (algorithm: "Comparison methods")
};

/// What can be said of a method without building it.
struct MethodInfo {
  Method method;
  MethodKind kind;
  const char* name;
  const char* what;        ///< it does, in a sentence
  const char* source;      ///< where it was published
  bool needs_whole_drive;  ///< cannot run live (whole_drive.h)
};

/// Throws std::out_of_range for a value that is no method.
const MethodInfo& infoOf(Method method);

/// Every method, in the order of the enumeration.
const std::vector<Method>& allMethods();

/// The names of all methods, in the order of the enumeration.
const std::vector<std::string>& namesOf(Method);

}  // namespace donex
