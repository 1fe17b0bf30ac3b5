// Loops over arrays of floats, compiled twice: for any machine, and with the wider registers most have. Which is run
// is decided when the program is loaded; both round alike (no contraction), so labels are the same everywhere.
#pragma once

// Sanitizers' run-time is not there yet when such a function is chosen.
#if defined(__x86_64__) && defined(__gnu_linux__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define DONEX_WIDE_LOOPS __attribute__((target_clones("avx2", "default")))
#else
#define DONEX_WIDE_LOOPS
#endif

namespace donex {

/// `x`, or the bound that it lies beyond; `low` for NaN, which a library's minimum and maximum may make anything of.
inline float clampedTo(float low, float high, float x) {
  const float from_low = x > low ? x : low;
  return from_low < high ? from_low : high;
}

}  // namespace donex
