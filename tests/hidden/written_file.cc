#include "tests/hidden/written_file.h"

#include "tests/hidden/judge.h"
#include "twin/benches/registry.h"
#include "twin/core/errors.h"
#include "twin/diagnose/extend.h"

namespace twinbench::hidden {

Scenario WrittenFile(const Scenario& believed, const diagnose::DiagnosisRun& found) {
  return ParseScenario(diagnose::ExtendedToml(believed, found, "hidden case"), "extended.toml", ".");
}

std::string Says(const std::vector<Reading>& readings, const Scenario& scenario,
                 const diagnose::DiagnoseOptions& options) {
  try {
    const diagnose::Diagnosis said = diagnose::Diagnose(readings, scenario, options).diagnosis;
    return said.verdict == diagnose::Verdict::kNone ? "" : Judge({}, said).answer;
  } catch (const InputError& refusal) {
    return std::string("refused: ") + refusal.what();
  }
}

}  // namespace twinbench::hidden
