#include "simulation/disturbance.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

#include "core/pi.h"
#include "simulation/random.h"

namespace donex::simulation {
namespace {

constexpr double kNearest = 1.5;     // [m] drops nearer are blown off the housing or too near to be measured
constexpr double kSnowReach = 20.0;  // [m] flakes are larger than drops and return more
constexpr float kFaint = 0.05F;      // intensity of drops, flakes and clouds
constexpr float kRetroreflective = 0.9F;
constexpr int kOwnEchoes = 400;
constexpr double kOwnNoise = 0.01;                           // [m] along the ray
constexpr double kSecondNearest = 0.3, kSecondFarthest = 8;  // [m] behind the first echo
constexpr double kHalo = 2.5 * kPi / 180.0;                  // [rad] radius of a halo

/// An ellipsoid of something thin, in the sensor's frame [m]; it follows the vehicle.
struct Plume {
  Eigen::Vector3d center, half;
};
const Plume kDustCloud{{-6.5, 0.0, -0.6}, {3.5, 2.2, 1.1}};
const std::array<Plume, 2> kSprayPlumes{Plume{{-4.5, 0.85, -1.2}, {2.2, 0.5, 0.5}},
                                        Plume{{-4.5, -0.85, -1.2}, {2.2, 0.5, 0.5}}};

/// A level plate of the own body, in the sensor's frame [m].
struct Plate {
  double share;  ///< of the echoes
  double x_min, x_max, half_width, z;
};
constexpr std::array<Plate, 2> kPlates{Plate{0.5, -1.3, 0.8, 0.6, -0.35}, Plate{0.5, 1.3, 2.3, 0.7, -0.75}};

enum class Step : std::uint64_t { kRain = 1, kSnow, kDust, kSpray, kBody, kSecond, kBloom };

/// Its own stream per step: an option more changes nothing of the others.
Random randomOf(std::uint64_t seed, std::size_t scan, Step step) {
  return Random(scramble(scramble(seed, scan + 1), static_cast<std::uint64_t>(step)));
}

bool isMeasured(const SimulatedEcho& echo) { return echo.position.allFinite(); }

void stopAt(double range, SimulatedEcho& echo, std::uint32_t& label) {
  echo.position *= static_cast<float>(range) / echo.position.norm();
  echo.intensity = kFaint;
  label = Disturbance::kDisturbed;
}

/// Drops and flakes: each stops a ray somewhere on its way, evenly up to `reach`.
void fall(double share, double reach, Random random, std::vector<SimulatedEcho>& echoes,
          std::vector<std::uint32_t>& labels) {
  for (std::size_t i = 0; i < echoes.size(); ++i) {
    const bool stops = random.chance(share);
    const double range = random.uniform(kNearest, reach);
    const bool is_on_its_way = isMeasured(echoes[i]) && range < static_cast<double>(echoes[i].position.norm());
    if (stops && is_on_its_way) stopAt(range, echoes[i], labels[i]);
  }
}

/// A ray is stopped with `share` times how much of the plume's diameter it crosses, anywhere in it.
void stopIn(const Plume& plume, double share, Random random, std::vector<SimulatedEcho>& echoes,
            std::vector<std::uint32_t>& labels) {
  const Eigen::Vector3d from = -plume.center.cwiseQuotient(plume.half);
  for (std::size_t i = 0; i < echoes.size(); ++i) {
    const double chance = random.uniform(), where = random.uniform();
    if (!isMeasured(echoes[i])) continue;
    const double range = static_cast<double>(echoes[i].position.norm());
    const Eigen::Vector3d ray = echoes[i].position.cast<double>().normalized();
    const Eigen::Vector3d step = ray.cwiseQuotient(plume.half);
    const double a = step.squaredNorm(), b = from.dot(step), c = from.squaredNorm() - 1.0;
    const double root = b * b - a * c;
    if (root <= 0.0) continue;
    const double enters = std::max((-b - std::sqrt(root)) / a, kNearest);
    const double leaves = std::min((-b + std::sqrt(root)) / a, range);
    if (leaves <= enters) continue;
    const double thickness = 0.5 * (leaves - enters) * std::sqrt(a);  // 1 through the middle
    if (chance < share * thickness) stopAt(enters + where * (leaves - enters), echoes[i], labels[i]);
  }
}

/// The same places in every scan, but for the noise of the range.
void addOwnBody(std::uint64_t seed, Random noise, std::vector<SimulatedEcho>& echoes,
                std::vector<std::uint32_t>& labels) {
  Random places = randomOf(seed, 0, Step::kBody);
  for (const Plate& plate : kPlates) {
    for (int i = 0; i < static_cast<int>(plate.share * kOwnEchoes); ++i) {
      Eigen::Vector3d place(places.uniform(plate.x_min, plate.x_max),
                            places.uniform(-plate.half_width, plate.half_width), plate.z);
      place *= 1.0 + kOwnNoise * noise.gaussian() / place.norm();
      echoes.push_back({place.cast<float>(), 0.3F, 0.0F, 0});
      labels.push_back(Disturbance::kDisturbed);
    }
  }
}

void addSecondReturns(double share, Random random, std::vector<SimulatedEcho>& echoes,
                      std::vector<std::uint32_t>& labels) {
  const std::size_t count = echoes.size();
  for (std::size_t i = 0; i < count; ++i) {
    const bool has_second = random.chance(share);
    const double behind = random.uniform(kSecondNearest, kSecondFarthest);
    if (!has_second || !isMeasured(echoes[i])) continue;
    SimulatedEcho second = echoes[i];
    const double range = static_cast<double>(second.position.norm());
    second.position *= static_cast<float>((range + behind) / range);
    second.intensity *= 0.5F;
    echoes.push_back(second);
    labels.push_back(Disturbance::kDisturbed);
  }
}

/// Echoes at the range of a strong reflector, beside it.
void addHalos(double per_echo, Random random, std::vector<SimulatedEcho>& echoes, std::vector<std::uint32_t>& labels) {
  const std::size_t count = echoes.size();
  for (std::size_t i = 0; i < count; ++i) {
    const bool is_strong = echoes[i].intensity >= kRetroreflective && isMeasured(echoes[i]);
    if (!is_strong) continue;
    const int whole = static_cast<int>(per_echo);
    const int halo = whole + (random.chance(per_echo - whole) ? 1 : 0);
    const bool moves = (labels[i] & 0xFFFFU) > 250;
    for (int k = 0; k < halo; ++k) {
      const double angle = random.uniform(0.0, 2.0 * kPi), away = kHalo * std::sqrt(random.uniform());
      const double turn = away * std::cos(angle), tilt = away * std::sin(angle);
      SimulatedEcho echo = echoes[i];
      const double range = static_cast<double>(echo.position.norm());
      const Eigen::Vector3d ray = echo.position.cast<double>().normalized();
      const Eigen::Vector3d side = Eigen::Vector3d(-ray.y(), ray.x(), 0.0);
      echo.position = (range * (ray + turn * side + tilt * Eigen::Vector3d::UnitZ()).normalized()).cast<float>();
      echoes.push_back(echo);
      labels.push_back(moves ? 0 : Disturbance::kDisturbed);
    }
  }
}

}  // namespace

bool DisturbanceOptions::any() const {
  return rain > 0.0 || snow > 0.0 || dust > 0.0 || spray > 0.0 || own_body || dual_returns > 0.0 || bloom > 0.0;
}

void Disturbance::apply(std::size_t scan, std::vector<SimulatedEcho>& echoes,
                        std::vector<std::uint32_t>& labels) const {
  const auto random = [&](Step step) { return randomOf(seed_, scan, step); };
  if (options_.bloom > 0.0) addHalos(options_.bloom, random(Step::kBloom), echoes, labels);
  if (options_.dual_returns > 0.0) addSecondReturns(options_.dual_returns, random(Step::kSecond), echoes, labels);
  if (options_.dust > 0.0) stopIn(kDustCloud, options_.dust, random(Step::kDust), echoes, labels);
  if (options_.spray > 0.0) {
    for (const Plume& plume : kSprayPlumes) stopIn(plume, options_.spray, random(Step::kSpray), echoes, labels);
  }
  if (options_.snow > 0.0) fall(options_.snow, kSnowReach, random(Step::kSnow), echoes, labels);
  if (options_.rain > 0.0) fall(options_.rain, options_.rain_reach, random(Step::kRain), echoes, labels);
  if (options_.own_body) addOwnBody(seed_, random(Step::kBody), echoes, labels);
}

}  // namespace donex::simulation
