#include "twin/diagnose/stated_outliers.h"

#include <algorithm>
#include <cmath>

namespace twinbench::diagnose {
namespace {

constexpr double kChance = 3.0;  // standard uncertainties by which there may be more than stated
constexpr double kLarger = 3.0;  // times the stated size: of a few, drawn at random

double Stated(const Scenario& scenario, const std::string& parameter) {
  double most = 0.0;
  for (const EffectSettings& effect : scenario.effects) {
    const auto found = effect.parameters.find(parameter);
    if (effect.name == "outliers" && found != effect.parameters.end()) most = std::max(most, found->second);
  }
  return most;
}

bool IsStated(const Cause& cause, const Scenario& scenario, int readings) {
  if (cause.effect != "outliers") return false;
  const auto value = [&cause](const char* name) {
    const auto p = std::ranges::find(cause.parameters, name, &ParameterEstimate::name);
    return p == cause.parameters.end() ? kNaN : p->value;
  };
  const double stated = Stated(scenario, "fraction"), u = std::sqrt(stated / std::max(1, readings));
  return value("fraction") <= stated + kChance * u && value("size") <= kLarger * Stated(scenario, "size");
}

}  // namespace

void LeaveOutStatedOutliers(const Scenario& scenario, DiagnosisRun& result) {
  Diagnosis& d = result.diagnosis;
  const auto erased =
      std::erase_if(d.causes, [&](const Cause& cause) { return IsStated(cause, scenario, d.readings); });
  if (erased == 0) return;
  d.noise.push_back("single values far outside, no more than the scenario states");
  d.alarm_p = result.structure_p;
  if (d.causes.empty() && d.verdict == Verdict::kNamed) d.verdict = Verdict::kNone;
}

}  // namespace twinbench::diagnose
