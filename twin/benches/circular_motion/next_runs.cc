#include <fmt/format.h>

#include <algorithm>

#include "twin/benches/circular_motion/bench.h"
#include "twin/benches/circular_motion/settings.h"
#include "twin/plan/next_run.h"

namespace twinbench::benches::circular {

std::vector<plan::NextRun> NextRunsOf(const Scenario& scenario) {
  const CircularProcedureSettings& p = CircularOf(scenario).procedure;
  const auto [slowest, fastest] = std::ranges::minmax(p.feeds_m_s);
  const auto feeds = [](double first, double second) {
    const double mm_min = 60.0 / units::mm;
    return fmt::format("circular_procedure.feeds_mm_min=[{:.6g}, {:.6g}]", first * mm_min, second * mm_min);
  };
  const double warmer_degC = scenario.environment.temperature_degC + 2.0;
  return {{"other-feeds",
           "the circles at half the slowest and twice the fastest feed",
           {feeds(0.5 * slowest, 2.0 * fastest)},
           plan::kOtherKind},
          {"finer",
           "three times as many readings a circle",
           {fmt::format("circular_procedure.points={}", 3 * p.points)},
           plan::kSameKind},
          {"quarter-on",
           "the circles begun a quarter of a turn on",
           {fmt::format("circular_procedure.start_deg={:.6g}", p.start_rad / units::deg + 90.0)},
           plan::kOtherKind},
          {"warm",
           "the same at a temperature 2 K higher",
           {fmt::format("environment.temperature_degC={}", warmer_degC)},
           plan::kOtherKind}};
}

}  // namespace twinbench::benches::circular
