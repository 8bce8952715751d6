#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "twin/diagnose/screen/circumstances.h"
#include "twin/diagnose/screen/tests.h"
#include "twin/diagnose/screen/words.h"

namespace twinbench::diagnose::screen {

/// Something jumps at one moment and stays: up to 200 onsets, the first of which leaves two readings before it.
Tests TestSteps(const Sample& sample) {
  constexpr int kMostOnsets = 200, kEdge = 2;
  const Schedule& schedule = sample.run.schedule;
  const int readings = schedule.Readings();
  const int every = std::max(1, (readings + kMostOnsets - 1) / kMostOnsets),
            onsets = (readings - 2 * kEdge) / every;
  if (onsets < 1) return {};
  Scan scan{{Eigen::MatrixXd::Zero(readings, onsets)}, 1};
  ScanWords words{"time: step", {}, "a knock, a slip, a mode hop, a lost or gained count"};
  for (int k = 0; k < onsets; ++k) {
    const int onset = kEdge + k * every;
    scan.shapes[0].col(k).tail(readings - onset).setOnes();
    words.items.push_back(fmt::format("a step near reading {} (at {:.0f} s)",
                                      schedule.reading[static_cast<std::size_t>(onset)], schedule.time_s[onset]));
  }
  Tests tests;
  Keep(TestScan(sample, scan, words), tests);
  return tests;
}

}  // namespace twinbench::diagnose::screen
