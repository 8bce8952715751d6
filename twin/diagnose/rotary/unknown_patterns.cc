#include <fmt/format.h>

#include "twin/diagnose/rotary/unknown_collector.h"

namespace twinbench::diagnose::rotary {
namespace {

constexpr int kWavesOfATone = 2;  // cos and sin

bool HasNoNamedTone(const Place& place) {
  return place.name == "roll" || place.name == "lateral";
}

bool HasNoNamedSlip(const Place& place) {
  return place.name == "roll" || place.name.starts_with("psd");
}

}  // namespace

/// Tones and steps where the catalogue has none, in time as the named ones.
void AddOtherPatterns(Collector& collect, const SharedSeries& series) {
  const auto add_tone = [&](const std::string& where, const Eigen::MatrixXd& map) {
    collect.AddAt(where, "tone of another pattern", series.tone, map, [f_Hz = series.frequency_Hz](int g) {
      return fmt::format("tone at {:.4g} Hz, locked to time", f_Hz[static_cast<std::size_t>(g)]);
    });
  };
  const auto add_step = [&](const std::string& where, const Eigen::MatrixXd& map) {
    collect.AddAt(where, "step of another pattern", series.step, map, [onset = series.onset](int g) {
      return fmt::format("step at reading {}, locked to time", onset[static_cast<std::size_t>(g)]);
    });
  };
  constexpr int kWaves = kWavesOfATone * kChannels;
  add_tone("all", Eigen::MatrixXd::Identity(kWaves, kWaves));
  add_step("all", Eigen::MatrixXd::Identity(kChannels, kChannels));
  for (const Place& place : collect.places()) {
    if (HasNoNamedTone(place)) add_tone(place.name, PatternMap(place.weight, kWavesOfATone));
    if (HasNoNamedSlip(place)) add_step(place.name, PatternMap(place.weight, 1));
  }
}

}  // namespace twinbench::diagnose::rotary
