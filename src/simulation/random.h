// Randomness that depends on a seed and a place only: the same on every machine, in every order of asking.
#pragma once

#include <cstdint>

namespace donex::simulation {

/// Scrambles all bits (the finaliser of splitmix64).
inline std::uint64_t scramble(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15ull;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ull;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBull;
  return x ^ (x >> 31);
}

inline std::uint64_t scramble(std::uint64_t a, std::uint64_t b) { return scramble(scramble(a) ^ b); }

/// The hash of a cell of a three-dimensional lattice.
inline std::uint64_t cellHash(int x, int y, int z, std::uint32_t seed) {
  const auto word = [](int v) { return static_cast<std::uint64_t>(static_cast<std::uint32_t>(v)); };
  return scramble((word(x) << 32 | word(y)) ^ (word(z) << 13) ^ (static_cast<std::uint64_t>(seed) << 20));
}

/// Nearly Gaussian from 64 random bits: sum of four uniforms, standard deviation 1, never beyond 3.47.
inline double gaussianFrom(std::uint64_t bits) {
  const auto part = [bits](int i) { return static_cast<double>(bits >> (16 * i) & 0xFFFF); };
  return (part(0) + part(1) + part(2) + part(3) - 131070.0) / 37837.0;
}

/// A stream of numbers.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(scramble(seed)) {}

  std::uint64_t bits() { return scramble(state_ += 0x9E3779B97F4A7C15ull); }
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  double gaussian() { return gaussianFrom(bits()); }
  bool chance(double probability) { return uniform() < probability; }
  /// 0 to count - 1.
  int below(int count) { return static_cast<int>(uniform() * count); }

 private:
  std::uint64_t state_;
};

}  // namespace donex::simulation
