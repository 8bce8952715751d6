#include <fmt/format.h>

#include <algorithm>

#include "twin/benches/freeform_five_axis/bench.h"
#include "twin/benches/freeform_five_axis/settings.h"
#include "twin/plan/next_run.h"

namespace twinbench::benches::freeform {

std::vector<plan::NextRun> NextRunsOf(const Scenario& scenario) {
  const FreeformProcedureSettings& p = FreeformOf(scenario).freeform_procedure;
  constexpr double kMost_deg = 20.0;
  const double angle_deg = std::min(2.0 * p.angle_rad / units::deg, std::max(kMost_deg, p.angle_rad / units::deg));
  const double warmer_degC = scenario.environment.temperature_degC + 2.0;
  return {
      {"more-poses",
       "twice as many poses",
       {fmt::format("freeform_procedure.poses={}", 2 * p.poses)},
       plan::kSameKind},
      {"wider-angles",
       "tilts of A and B twice as far",
       {fmt::format("freeform_procedure.angle_deg={:.6g}", angle_deg)},
       plan::kOtherKind},
      {"one-by-one", "the axes moved one after the other", {"freeform_procedure.path=single"}, plan::kOtherKind},
      {"wider-dither",
       "the axes scattered ten times as far about every pose",
       {fmt::format("freeform_procedure.dither_um={:.6g}", std::min(1e3, 10.0 * p.dither_m / units::um)),
        fmt::format("freeform_procedure.dither_deg={:.6g}", 10.0 * p.dither_rad / units::deg)},
       plan::kOtherKind},
      {"warm",
       "the same at a temperature 2 K higher",
       {fmt::format("environment.temperature_degC={}", warmer_degC)},
       plan::kOtherKind}};
}

}  // namespace twinbench::benches::freeform
