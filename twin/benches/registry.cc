#include "twin/benches/registry.h"

#include <algorithm>

#include "twin/diagnose/missing.h"
#include "twin/diagnose/stated_outliers.h"
#include "twin/diagnose/written_file.h"

namespace twinbench {

const Bench& BenchNamed(const std::string& name) {
  const auto found = std::ranges::find(Benches(), name, [](const Bench* bench) { return bench->format->name; });
  if (found == Benches().end()) throw UnknownBench("bench", name);
  return **found;
}

const Bench& BenchOf(const Scenario& scenario) {
  return BenchNamed(scenario.bench);
}

std::string BenchesWhere(const std::function<bool(const Bench&)>& holds) {
  std::string text = "bench";
  const char* separator = " ";
  for (const Bench* bench : Benches()) {
    if (!holds(*bench)) continue;
    text += separator + bench->format->name;
    separator = " or ";
  }
  return text;
}

namespace diagnose {
namespace {

/// What differs by less than any instrument resolves - in rad, m or V - was computed from the other.
bool IsComputed(const DiagnosisRun& result) {
  constexpr double kNoInstrument = 1e-13;
  return result.run.Rows() > 0 && result.run.residual.cwiseAbs().maxCoeff() < kNoInstrument;
}

}  // namespace

DiagnosisRun Diagnose(const std::vector<Reading>& readings, const Scenario& scenario,
                      const DiagnoseOptions& options) {
  const Bench& bench = BenchOf(scenario);
  DiagnosisRun result = bench.diagnose(readings, scenario, options);
  if (!options.design_only && IsComputed(result)) {
    DiagnoseOptions no_search = options;
    no_search.design_only = true;
    result = bench.diagnose(readings, scenario, no_search);
    result.diagnosis.notes.emplace_back("readings and scenario agree to the last digits of numbers, better than any instrument resolves: "
                                        "one is computed from the other, and there is nothing to diagnose");
  }
  JudgeByFile(readings, scenario, options, bench.linear_run, result);
  LeaveOutStatedOutliers(scenario, result);
  const std::vector<std::string> missing = MissingColumns(readings, scenario.bench);
  result.diagnosis.notes.insert(result.diagnosis.notes.end(), missing.begin(), missing.end());
  return result;
}

}  // namespace diagnose
}  // namespace twinbench
