#include "tests/hidden/unlisted_cause.h"

#include <cmath>

#include "tests/hidden/placements.h"
#include "twin/benches/names.h"

namespace twinbench::hidden {
namespace {

/// Weights of a pattern of motion on psd_a_x, psd_a_y, psd_b_x, psd_b_y.
Eigen::RowVector4d Pattern(const std::string& name) {
  if (name == "yaw") return {1, 0, 1, 0};
  if (name == "tilt") return {0, 1, 0, 1};
  if (name == "roll") return {0, 1, 0, -1};
  Eigen::RowVector4d one = Eigen::RowVector4d::Zero();
  for (int c = 0; c < kChannels; ++c) {
    if (name == kChannelNames[static_cast<std::size_t>(c)]) one[c] = 1.0;
  }
  return one;
}

std::vector<std::string> ChannelsOf(const Eigen::RowVector4d& pattern) {
  std::vector<std::string> channels;
  for (int c = 0; c < kChannels; ++c) {
    if (pattern[c] != 0.0) channels.emplace_back(kChannelNames[static_cast<std::size_t>(c)]);
  }
  return channels;
}

/// Adds the signal at the size that gives it the length `rho`.
void AddWithLength(double rho, const std::string& bench, const Eigen::MatrixXd& signal, const SignatureScale& scale,
                   std::uint64_t seed, std::vector<Reading>& readings) {
  constexpr double kUnit = 1e-6;
  std::vector<Reading> with = readings;
  AddTo(bench, kUnit * signal, with);
  AddTo(bench, kUnit * rho / scale.Rho(with, readings, seed) * signal, readings);
}

Case MakeUnlisted(Design design, const UnlistedCause& cause, double rho, std::uint64_t seed,
                  const SignatureScale& scale) {
  Case made;
  made.scenario = Believed(design);
  made.readings = TakeReadings(Drawn(design, seed));
  Stream stream(seed, "hidden.unlisted");
  const UnlistedSignal drawn = cause.draw({made.readings, stream, stream});
  AddWithLength(rho, BenchOf(design), drawn.signal, scale, seed, made.readings);
  made.hidden.unlisted = cause.name;
  made.hidden.locks = drawn.locks;
  made.hidden.channels = drawn.channels;
  made.hidden.rho = rho;
  return made;
}

}  // namespace

double Draw::Hours(std::size_t i) const {
  return ToSeconds(readings[i].time - readings[0].time) / units::hour;
}

double Draw::StepHours(std::size_t i) const {
  return i == 0 ? 0.0 : Hours(i) - Hours(i - 1);
}

double Draw::Spot_m(std::size_t i, std::size_t channel) const {
  return readings[i].mean_V[channel] / kSensitivity_V_m;
}

Draw::Value Draw::DirectionMap(Angle angle, int first_order, int last_order) const {
  const int order = Whole(first_order, last_order);
  return [this, angle, order, phase = Phase()](std::size_t i) {
    return readings[i].direction * std::cos(order * readings[i].*angle + phase);
  };
}

Draw::Value Draw::LineBetween(Angle angle, int first_order, int last_order) const {
  const int whole = Whole(first_order, last_order);
  const double order = whole + UniformIn(stream, 0.3, 0.7);
  return
      [this, angle, order, phase = Phase()](std::size_t i) { return std::cos(order * readings[i].*angle + phase); };
}

Draw::Value Draw::Wander(double from_min, double to_min) const {
  const double minutes = UniformIn(stream, from_min, to_min);
  std::vector<double> levels;
  for (int k = 0; k < 200; ++k) levels.push_back(of_run.Normal());
  return [this, minutes, levels](std::size_t i) {
    const double at = 60.0 * Hours(i) / minutes;
    const auto k = static_cast<std::size_t>(at) % (levels.size() - 1);
    return levels[k] + (at - std::floor(at)) * (levels[k + 1] - levels[k]);
  };
}

Eigen::VectorXd Draw::Series(const Value& value) const {
  Eigen::VectorXd series(static_cast<Eigen::Index>(readings.size()));
  for (std::size_t i = 0; i < readings.size(); ++i) series[static_cast<Eigen::Index>(i)] = value(i);
  return series;
}

Eigen::VectorXd Draw::FullCircleSeries(const Value& value) const {
  return Series([&](std::size_t i) { return readings[i].phase == Phase::kFullCircle ? value(i) : 0.0; });
}

UnlistedSignal OnPattern(const std::string& pattern, const std::vector<std::string>& locks,
                         const Eigen::VectorXd& series) {
  return {locks, ChannelsOf(Pattern(pattern)), series * Pattern(pattern)};
}

UnlistedSignal OnChannel(std::size_t channel, const std::vector<std::string>& locks,
                         const Eigen::VectorXd& series) {
  return OnPattern(kChannelNames[channel], locks, series);
}

UnlistedSignal OnAxis(const std::string& axis, const std::vector<std::string>& locks,
                      const Eigen::VectorXd& series) {
  const Eigen::RowVector2d weight = axis == "x" ? Eigen::RowVector2d(1, 0) : Eigen::RowVector2d(0, 1);
  return {locks, {}, series * weight};
}

UnlistedSignal OnColumn(Eigen::Index channel, Eigen::Index channels, const std::vector<std::string>& locks,
                        const Eigen::VectorXd& series) {
  return {locks, {}, series * Eigen::RowVectorXd::Unit(channels, channel)};
}

UnlistedSignal OnAngle(const std::vector<std::string>& locks, const Eigen::VectorXd& series) {
  return {locks, {}, series};
}

std::vector<Plan> UnlistedPlans(const std::string& bench, const TwinOptions& options) {
  std::vector<Plan> plans;
  std::uint64_t seed = 400000 + options.first_seed;
  for (const Design design : PlainDesigns(bench)) {
    for (const UnlistedCause& cause : UnlistedCausesOf(bench)) {
      for (int k = 0; k < options.magnitudes * options.seeds; ++k) {
        ++seed;
        const double rho = options.RhoOf(k);
        plans.push_back({"unlisted " + bench, std::to_string(seed),
                         [=] { return MakeUnlisted(design, cause, rho, seed, ScaleOf(design)); }});
      }
    }
  }
  return plans;
}

}  // namespace twinbench::hidden
