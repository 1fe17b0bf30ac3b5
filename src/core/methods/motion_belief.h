// Evidence on whether an echo is dynamic, and Dempster's rule to combine it.
#pragma once

namespace donex {

/// Masses over {dynamic}, {static} and both (nothing known); they add up to 1.
/// G. Shafer, "A Mathematical Theory of Evidence" (1976); Lee, Kim & Jo 2019, section 4.
struct MotionBelief {
  double dynamic = 0.0;
  double fixed = 0.0;

  double unknown() const { return 1.0 - dynamic - fixed; }

  /// Dempster's rule. Two beliefs that contradict one another wholly leave nothing known.
  MotionBelief combinedWith(const MotionBelief& other) const {
    const double conflict = dynamic * other.fixed + fixed * other.dynamic;
    if (conflict >= 1.0) return {};
    const double agreed = 1.0 / (1.0 - conflict);
    return {agreed * (dynamic * other.dynamic + dynamic * other.unknown() + unknown() * other.dynamic),
            agreed * (fixed * other.fixed + fixed * other.unknown() + unknown() * other.fixed)};
  }
};

}  // namespace donex
