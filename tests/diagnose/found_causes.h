#pragma once

#include "twin/benches/names.h"
#include "twin/report/diagnosis_text.h"

/// Diagnoses as a search may leave them, for the tests of what becomes of them: file, words, extended scenario.
namespace twinbench::diagnose::test {

/// As sure as a diagnosis ever is, with one fitted parameter.
inline Cause FoundCause(const std::string& effect, const std::string& where, const ParameterEstimate& parameter) {
  return {.effect = effect, .where = where, .probability = 0.97, .parameters = {parameter}};
}

inline Cause FoundPsdGain(double gain_error) {
  return FoundCause("psd_gain", "psd_a_x", {"gain_error", "1", 1.0, gain_error, 2e-4, -0.5, 0.5});
}

/// A model that predicts held-out passes nearly as well as their noise allows.
inline Gain ClearGain() {
  return {.before_m = 0.71e-6, .after_m = 0.31e-6, .noise_floor_m = 0.30e-6, .fraction_removed = 0.97,
          .interval95 = {0.95, 0.99}, .positive = true, .folds = 4};
}

/// A run of the rotary bench with one named cause.
inline DiagnosisRun NamedRun(const Cause& cause) {
  DiagnosisRun run;
  run.run.bench = kRotaryBench;
  run.run.unit = "um";
  run.run.to_SI = 1e-6;
  run.diagnosis.verdict = Verdict::kNamed;
  run.diagnosis.causes = {cause};
  run.diagnosis.gain = ClearGain();
  return run;
}

/// What a cause that cannot be seen could bias.
inline std::string CouldBias(const Diagnosis& d, const std::string& effect, const std::string& where = "") {
  const auto found = std::ranges::find_if(
      d.invisible, [&](const Invisible& one) { return one.effect == effect && one.where == where; });
  return found == d.invisible.end() ? "(it says that it would be seen)" : found->could_bias;
}

/// All that a diagnosis says, for the message of a test that fails.
inline std::string Told(const DiagnosisRun& found) {
  return report::DiagnosisText({found, ShownBy(found), "the readings"}, {report::Letters::kAscii, true});
}

}  // namespace twinbench::diagnose::test
