#include "twin/benches/rotary_4dof/diagnosis/configuration.h"

#include <algorithm>
#include <utility>

#include "twin/benches/rotary_4dof/estimators/separate.h"

namespace twinbench::diagnose::rotary {
namespace {

/// Only what FindLayout looks at.
measure::Motion LabelOf(const Reading& r) {
  measure::Motion m;
  m.reading = r.reading;
  m.setup = r.setup;
  m.phase = r.phase;
  m.target_rad = r.target_rad;
  m.reference_rad = r.reference_rad;
  m.status = ReadingStatus::kOk;
  return m;
}

separate::LayoutOptions OptionsOf(const Scenario& scenario, bool published) {
  separate::LayoutOptions layout = separate::OptionsFrom(scenario).layout;
  if (published) layout.clamping = separate::Clamping::kReseat;
  const auto reclamped = [](const EffectSettings& e) { return e.name == "reclamp_frame"; };
  if (std::ranges::any_of(scenario.effects, reclamped)) layout.clamping = separate::Clamping::kReclamp;
  return layout;
}

Configuration StanceOf(const Reading& r) {
  Configuration configuration;
  if (r.phase != Phase::kCalibration) return configuration;
  configuration.swept_yaw_rad = r.autocollimator_yaw_rad;
  configuration.swept_tilt_rad = r.autocollimator_tilt_rad;
  return configuration;
}

}  // namespace

Configurations FindConfigurations(const std::vector<Reading>& used, const Scenario& scenario,
                                  const measure::BenchGeometry& geometry, bool published) {
  std::vector<measure::Motion> labels;
  std::ranges::transform(used, std::back_inserter(labels), LabelOf);
  separate::Layout layout = separate::FindLayout(labels, geometry, OptionsOf(scenario, published));
  Configurations configurations{std::move(layout.design), {}};
  std::ranges::transform(used, std::back_inserter(configurations.of_reading), StanceOf);
  for (const separate::Sample& s : layout.samples) {
    configurations.of_reading[s.motion].setup = s.setup;
    configurations.of_reading[s.motion].target = s.target;
  }
  return configurations;
}

}  // namespace twinbench::diagnose::rotary
