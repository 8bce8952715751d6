#include <fmt/format.h>

#include "twin/benches/encoder_comparison/bench.h"
#include "twin/benches/encoder_comparison/settings.h"
#include "twin/plan/next_run.h"

namespace twinbench::benches::encoder {
namespace {

using plan::NextRun;

const std::string kStops = "encoder_procedure.kind=stops", kSweep = "encoder_procedure.kind=sweep";
const std::string kForthAndBack = "encoder_procedure.passes=[1, -1, -1, 1]";

std::string Speeds(double first, double second) {
  return fmt::format("encoder_procedure.speeds_deg_s=[{:.6g}, {:.6g}]", first, second);
}

}  // namespace

std::vector<NextRun> NextRunsOf(const Scenario& scenario) {
  const EncoderProcedureSettings& p = EncoderOf(scenario).encoder_procedure;
  const double speed = p.speeds_rad_s.empty() ? 30.0 : p.speeds_rad_s.front() / units::deg;
  const std::string finer = fmt::format("encoder_procedure.stops_per_turn={}", 2 * p.stops + 1);
  return {
      {"at-rest", "stops at rest, forth and back", {kStops, kForthAndBack}, plan::kOtherKind},
      {"finer",
       "more than twice as many stops, no whole multiple, forth and back",
       {kStops, finer, kForthAndBack},
       plan::kSameKind},
      {"two-speeds",
       "the passes in motion at half and at twice the speed",
       {kSweep, Speeds(0.5 * speed, 2.0 * speed), kForthAndBack},
       plan::kOtherKind},
      {"slow",
       "the passes in motion, slowly",
       {kSweep, Speeds(0.2 * speed, 0.5 * speed), kForthAndBack},
       plan::kOtherKind},
      {"many-turns",
       "five turns of stops in either direction",
       {kStops, "encoder_procedure.turns=5", "encoder_procedure.passes=[1, -1]"},
       plan::kSameKind},
      {"mountings",
       "three mountings of the device on the shaft",
       {kStops, "encoder_procedure.mounting_deg=[0, 97, 213]", "encoder_procedure.passes=[1, -1]"},
       plan::kOtherKind},
      {"longer-stops",
       "the stops three times as long",
       {kStops, kForthAndBack, fmt::format("encoder_procedure.stop_interval_s={:.6g}", 3.0 * p.stop_interval_s)},
       plan::kSameKind}};
}

}  // namespace twinbench::benches::encoder
