#include "twin/sim/environment.h"

#include <algorithm>
#include <cmath>

#include "twin/core/units.h"

namespace twinbench::sim {
namespace {

constexpr double kWalkStep_s = 60.0;

}  // namespace

Environment::Environment(const EnvironmentSettings& settings, std::uint64_t seed)
    : settings_(settings), walk_steps_(seed, "environment.walk"), sensor_noise_(seed, "environment.sensor") {
  if (settings_.temperature_file.empty()) return;
  record_degC_ = ReadSampledCurve(settings_.temperature_file, {"time_s"}, {"temperature_degC"});
}

double Environment::Temperature_degC(Time now) {
  const double t_s = ToSeconds(now);
  const double level_degC = record_degC_.IsEmpty() ? settings_.temperature_degC : record_degC_.At(t_s);
  const double swing_K = settings_.swing_K == 0.0
                             ? 0.0
                             : settings_.swing_K * std::sin(2.0 * units::kPi * t_s / settings_.swing_period_s);
  return level_degC + settings_.drift_K_h * t_s / units::hour + swing_K + RandomWalk_K(t_s);
}

double Environment::Measure_degC(Time now) {
  const double noise_K = settings_.sensor_noise_K > 0.0 ? settings_.sensor_noise_K * sensor_noise_.Normal() : 0.0;
  return Temperature_degC(now) + noise_K;
}

double Environment::RandomWalk_K(double t_s) {
  if (settings_.random_walk_K_sqrt_h == 0.0) return 0.0;
  const double steps = std::max(0.0, t_s / kWalkStep_s);
  const auto index = static_cast<std::size_t>(steps);
  const double sd_K = settings_.random_walk_K_sqrt_h * std::sqrt(kWalkStep_s / units::hour);
  while (walk_K_.size() <= index + 1) walk_K_.push_back(walk_K_.back() + sd_K * walk_steps_.Normal());
  return std::lerp(walk_K_[index], walk_K_[index + 1], steps - static_cast<double>(index));
}

}  // namespace twinbench::sim
