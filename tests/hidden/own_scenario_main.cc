#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "tests/hidden/own_scenario.h"

/// Run by hand: which stated settings the diagnosis takes for something that the scenario gets wrong.
int main(int argc, char** argv) {
  CLI::App app("Diagnoses runs of the twin, one key changed in each, against their own scenarios");
  std::string bench = "rotary_4dof", only, cache;
  int seeds = 1;
  app.add_option("bench", bench);
  app.add_option("--only", only, "keys that hold this");
  app.add_option("--seeds", seeds);
  app.add_option("--cache", cache);
  CLI11_PARSE(app, argc, argv);
  int runs = 0, alarms = 0;
  for (const auto& change : twinbench::hidden::KeyChanges(bench)) {
    if (change.key.find(only) == std::string::npos) continue;
    for (int seed = 1; seed <= seeds; ++seed) {
      ++runs;
      try {
        const auto d = twinbench::hidden::DiagnosedAgainstItself(
            twinbench::hidden::ChangedBench(bench, change, static_cast<std::uint64_t>(seed)), cache);
        if (d.verdict == twinbench::diagnose::Verdict::kNone) continue;
        ++alarms;
        std::printf("%s=%s seed %d (%d readings, %d left out): p %.2g, %s\n", change.key.c_str(), change.value.c_str(), seed, d.readings, d.left_out, d.alarm_p,
                    d.causes.empty() ? d.unknown.signature.c_str()
                                     : (d.causes[0].effect + " " + d.causes[0].where + " " +
                                        std::to_string(d.causes[0].probability))
                                           .c_str());
      } catch (const std::exception& error) {
        ++alarms;
        std::printf("%s=%s seed %d: %s\n", change.key.c_str(), change.value.c_str(), seed, error.what());
      }
      std::fflush(stdout);
    }
  }
  std::printf("%d alarms in %d runs\n", alarms, runs);
}
