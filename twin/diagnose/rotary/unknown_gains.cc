#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "twin/diagnose/rotary/signals.h"
#include "twin/diagnose/rotary/unknown_collector.h"

namespace twinbench::diagnose::rotary {
namespace {

/// Name and time course of something that a gain may follow.
using Followed = std::pair<std::string, Eigen::VectorXd>;

/// Above its mean in the calibration: the gains were right there, whatever they followed. Of a run without one:
/// above its first value.
Eigen::VectorXd SinceCalibration(const Schedule& s, const Eigen::VectorXd& signal) {
  double sum = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < s.phase.size(); ++i) {
    if (s.phase[i] != Phase::kCalibration) continue;
    sum += signal[static_cast<Eigen::Index>(i)];
    ++count;
  }
  return Unit((signal.array() - (count > 0 ? sum / count : signal[0])).matrix());
}

std::vector<Followed> WhatIsFollowed(const Schedule& s, double reference_degC) {
  constexpr double kWarmUps = 3.0;  // time constants in a run, of something that warms up and stays
  const Eigen::VectorXd time =
      (s.time_s.array() - s.time_s.minCoeff()) / std::max(1.0, s.time_s.maxCoeff() - s.time_s.minCoeff());
  const Eigen::VectorXd warm = 1.0 - (-kWarmUps * time.array()).exp();
  std::vector<Followed> followed = {{"time", Unit((time.array() - time.mean()).matrix())},
                                    {"time", SinceCalibration(s, time)},
                                    {"time", SinceCalibration(s, warm)},
                                    {"direction", DirectionSignal(s)}};
  if (!s.temperature_degC.array().isFinite().any()) return followed;
  const Eigen::VectorXd T = LaggedTemperature(s, reference_degC, 0.0);
  followed.emplace_back("temperature", Unit((T.array() - T.mean()).matrix()));
  followed.emplace_back("temperature", SinceCalibration(s, T));
  followed.emplace_back("temperature", Unit(T));  // nothing at the reference temperature
  return followed;
}

/// The channels with a gain of their own, with a common one on each PSD, or with four at once.
std::vector<std::pair<std::string, Eigen::MatrixXd>> MapsOfGains(const Eigen::Matrix4d& shown_by_motion) {
  std::vector<std::pair<std::string, Eigen::MatrixXd>> maps;
  for (int c = 0; c < kChannels; ++c) {
    maps.emplace_back(kChannelNames[static_cast<std::size_t>(c)], Eigen::Vector4d::Unit(c));
  }
  for (const char* psd : {"psd_a", "psd_b"}) maps.emplace_back(psd, WeightOf(psd, shown_by_motion));
  maps.emplace_back("all", Eigen::MatrixXd::Identity(kChannels, kChannels));
  return maps;
}

/// What each channel shows, times the signal.
Eigen::MatrixXd ScaledBy(const Eigen::VectorXd& signal, const Eigen::VectorXd& shown_m) {
  const Eigen::MatrixXd rows = OnEachChannel(signal, kChannels);
  return rows.array().colwise() * shown_m.array();
}

void AddGain(Collector& collect, const std::string& where, const std::string& what,
             const Eigen::MatrixXd& columns) {
  Family& family = collect.New(where, "gain follows " + what, {"scale", "1", 1.0, kPlausibleShare}, columns.cols());
  family.group = "gain changes";  // whatever it follows
  family.columns = [columns](int) { return columns; };
  family.describe = [where, what](int, const Eigen::VectorXd& x) {
    return fmt::format("gain of {} follows {}, locked to {} and spot, {:.2g} rms", where, what, what, x.norm());
  };
}

}  // namespace

void AddGains(Collector& collect) {
  const SignalContext& context = collect.context();
  const auto maps = MapsOfGains(context.shown_by_motion);
  for (const auto& [what, signal] : WhatIsFollowed(collect.schedule(), context.reference_degC)) {
    const Eigen::MatrixXd scaled = ScaledBy(signal, context.shown_m);
    for (const auto& [where, map] : maps) AddGain(collect, where, what, scaled * map);
  }
}

}  // namespace twinbench::diagnose::rotary
