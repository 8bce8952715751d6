#pragma once

#include <map>

#include "tests/support/angle_benches.h"

namespace twinbench::test {

/// A scenario of scenarios/ as its file says, carried out once for all tests that ask for it.
inline const BenchRun& AsShipped(const std::string& file) {
  static std::map<std::string, BenchRun> runs;
  const auto found = runs.find(file);
  if (found != runs.end()) return found->second;
  return runs[file] = RunBench(LoadScenario(ScenarioPath(file)));
}

}  // namespace twinbench::test
