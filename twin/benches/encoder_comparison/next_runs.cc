#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "twin/benches/encoder_comparison/bench.h"
#include "twin/benches/encoder_comparison/settings.h"
#include "twin/plan/next_run.h"
#include "twin/plan/shift_sets.h"

namespace twinbench::benches::encoder {
namespace {

using plan::NextRun;

const std::string kStops = "encoder_procedure.kind=stops", kSweep = "encoder_procedure.kind=sweep";
const std::string kForthAndBack = "encoder_procedure.passes=[1, -1, -1, 1]";

std::string Speeds(double first, double second) {
  return fmt::format("encoder_procedure.speeds_deg_s=[{:.6g}, {:.6g}]", first, second);
}

/// Heads on one ring, at whole degrees here: the ring's curve and what is read at one instant alike by all heads
/// are two curves, and the heads' places shifts.
plan::ShiftDesign HeadsDesign(const std::vector<double>& heads_rad) {
  plan::ShiftDesign design;
  design.positions = 360;
  for (const double head_rad : heads_rad)
    design.shifts.push_back(static_cast<int>(std::lround(head_rad / units::deg)));
  design.sets = [](const std::vector<int>& heads_deg) {
    return std::vector{fmt::format("encoder_procedure.heads_deg=[{}]", fmt::join(heads_deg, ", "))};
  };
  design.words = "heads at [deg]";
  return design;
}

/// Mountings of the device on the shaft, by whole stops.
plan::ShiftDesign MountingsDesign(const EncoderProcedureSettings& p) {
  plan::ShiftDesign design;
  design.positions = p.stops;
  for (const double at_rad : p.mounting_rad)
    design.shifts.push_back(static_cast<int>(std::lround(at_rad / units::turn * p.stops)));
  design.sets = [stops = p.stops](const std::vector<int>& shifts) {
    std::vector<double> mounting_deg;
    for (const int shift : shifts) mounting_deg.push_back(360.0 * shift / stops);
    return std::vector{fmt::format("encoder_procedure.mounting_deg=[{:.9g}]", fmt::join(mounting_deg, ", "))};
  };
  design.words = "mountings at the shifts";
  return design;
}

/// At every stop, as far as it is long enough.
void AddLongerReadings(const EncoderProcedureSettings& p, std::vector<NextRun>& runs) {
  const int most = static_cast<int>(p.stop_interval_s / p.read_s),
            count = std::min(plan::kTimesTheReadings * p.readings_per_stop, most);
  if (count <= p.readings_per_stop) return;
  runs.push_back(plan::LongerReadings(fmt::format("the same measuring positions, each the mean of {} readings", count),
                                      "encoder_procedure.readings_per_stop", count));
}

/// In motion, as far as a reading's own time allows.
void AddDenserReadings(const EncoderProcedureSettings& p, std::vector<NextRun>& runs) {
  const double interval_s = std::max(p.read_s, p.interval_s / plan::kTimesTheReadings);
  if (interval_s >= p.interval_s) return;
  runs.push_back(plan::DenserReadings(fmt::format("the same motion, a reading every {:.3g} s", interval_s),
                                      fmt::format("encoder_procedure.interval_s={:.9g}", interval_s)));
}

}  // namespace

plan::ShiftDesign ShiftsOf(const Scenario& scenario) {
  const EncoderProcedureSettings& p = EncoderOf(scenario).encoder_procedure;
  if (p.heads_rad.size() > 1) return HeadsDesign(p.heads_rad);
  return p.mounting_rad.size() > 1 && p.kind == "stops" ? MountingsDesign(p) : plan::ShiftDesign{};
}

std::vector<NextRun> NextRunsOf(const Scenario& scenario) {
  const EncoderProcedureSettings& p = EncoderOf(scenario).encoder_procedure;
  const double speed = p.speeds_rad_s.empty() ? 30.0 : p.speeds_rad_s.front() / units::deg;
  const std::string finer = fmt::format("encoder_procedure.stops_per_turn={}", 2 * p.stops + 1);
  std::vector<NextRun> runs = {
      {"at-rest", "measuring positions at rest, forth and back", {kStops, kForthAndBack}, plan::kOtherKind},
      {"finer",
       "more than twice as many measuring positions, no whole multiple, forth and back",
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
       "five turns of measuring positions in either direction",
       {kStops, "encoder_procedure.turns=5", "encoder_procedure.passes=[1, -1]"},
       plan::kSameKind},
      {"mountings",
       "three mountings of the device on the shaft",
       {kStops, "encoder_procedure.mounting_deg=[0, 97, 213]", "encoder_procedure.passes=[1, -1]"},
       plan::kOtherKind},
      {"longer-stops",
       "three times as long at each measuring position",
       {kStops, kForthAndBack, fmt::format("encoder_procedure.stop_interval_s={:.6g}", 3.0 * p.stop_interval_s)},
       plan::kSameKind}};
  if (p.kind == "stops") AddLongerReadings(p, runs);
  if (p.kind == "sweep") AddDenserReadings(p, runs);
  return runs;
}

}  // namespace twinbench::benches::encoder
