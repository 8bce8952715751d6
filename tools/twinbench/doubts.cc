#include "tools/twinbench/doubts.h"

#include <fmt/core.h>

#include "twin/benches/expected.h"

namespace twinbench::tools {

std::vector<std::string> TellDoubts(const std::vector<Reading>& readings, const Scenario& scenario, const std::string& where,
                                    std::FILE* to) {
  const std::vector<plausible::Finding> findings = DoubtsAbout(readings, scenario);
  fmt::print(to, "{}", plausible::InLines(findings));
  plausible::RefuseFatal(findings, where);
  std::vector<std::string> lines;
  for (const plausible::Finding& finding : findings) lines.push_back(finding.line);
  return lines;
}

RecordedRun LoadPlausibleRun(const std::string& source, const std::string& scenario_path,
                             const std::vector<std::string>& overrides) {
  RecordedRun run = LoadRecordedRun(source, scenario_path, overrides);
  TellDoubts(run.readings, run.scenario, source);
  return run;
}

}  // namespace twinbench::tools
