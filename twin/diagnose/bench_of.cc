#include "twin/diagnose/bench_of.h"

#include <vector>

#include "twin/core/scenario.h"

namespace twinbench::diagnose {

std::string BenchOf(const LinearRun& run) {
  if (run.channels == std::vector<std::string>{"angle"}) return kEncoderBench;
  if (run.channels == std::vector<std::string>{"x", "y"}) return kTurntableBench;
  if (!run.channels.empty() && run.channels.front() == "transmission") return kHobBench;
  return kRotaryBench;
}

}  // namespace twinbench::diagnose
