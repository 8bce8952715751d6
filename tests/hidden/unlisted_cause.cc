#include "tests/hidden/unlisted_cause.h"

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

}  // namespace twinbench::hidden
