#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "twin/benches/hob_transmission/bench.h"
#include "twin/benches/hob_transmission/settings.h"
#include "twin/plan/next_run.h"
#include "twin/plan/shift_sets.h"

namespace twinbench::benches::hob {
namespace {

/// Samples that the counter card's FIFO holds between two looks of the computer, at the fastest pass; half of it is
/// for a look that comes late.
double MostSamplesPerTurn(const HobSettings& own) {
  constexpr double kOfTheFifo = 0.5;
  const HobProcedureSettings& p = own.hob_procedure;
  const double hob_rad_s = *std::max_element(p.hob_speeds_rad_s.begin(), p.hob_speeds_rad_s.end());
  const double table_turns_s = hob_rad_s / units::turn * own.transmission.hob_starts / own.transmission.gear_teeth;
  return kOfTheFifo * p.fifo_samples / (p.poll_s * table_turns_s);
}

/// More of the lines that the ring has, evenly spaced.
void AddDenserReadings(const HobSettings& own, std::vector<plan::NextRun>& runs) {
  const int now = own.hob_procedure.samples_per_turn, lines = own.table_encoder.lines;
  const double most = std::min(plan::kTimesTheReadings * static_cast<double>(now), MostSamplesPerTurn(own));
  int every = 1;
  while (lines % every != 0 || lines / every > most) ++every;
  const int samples = lines / every;
  if (samples <= now) return;
  runs.push_back(plan::DenserReadings(fmt::format("the same motion, {} samples per turn", samples),
                                      fmt::format("hob_procedure.samples_per_turn={}", samples)));
}

}  // namespace

std::vector<plan::NextRun> NextRunsOf(const Scenario& scenario) {
  const HobSettings& own = HobOf(scenario);
  const HobProcedureSettings& p = own.hob_procedure;
  const double speed_rev_min = p.hob_speeds_rad_s.front() * 60.0 / (2.0 * units::kPi);
  const std::string two_turns = "hob_procedure.turns=2";
  std::vector<plan::NextRun> runs = {
      {"three-heads",
       "ring and head at three places",
       {"hob_procedure.heads_deg=[0, 97, 213]", "hob_procedure.passes=[1, -1]", two_turns},
       plan::kOtherKind},
      {"two-speeds",
       "the passes at half and at twice the speed",
       {fmt::format("hob_procedure.hob_speeds_rev_min=[{:.6g}, {:.6g}]", 0.5 * speed_rev_min, 2.0 * speed_rev_min),
        "hob_procedure.passes=[1, -1]", two_turns},
       plan::kOtherKind},
      {"both-ways", "passes + - - +", {"hob_procedure.passes=[1, -1, -1, 1]", two_turns}, plan::kSameKind},
      {"many-turns",
       "eight turns of the table one way",
       {"hob_procedure.turns=8", "hob_procedure.passes=[1]"},
       plan::kSameKind},
      {"one-head",
       "one place of the head, forth and back",
       {fmt::format("hob_procedure.heads_deg=[{:.6g}]", p.heads_rad.front() / units::deg),
        "hob_procedure.passes=[1, -1]", two_turns},
       plan::kSameKind}};
  AddDenserReadings(own, runs);
  return runs;
}

/// The gears' error by the table's angle and the ring's by where it stands under the head: two curves, and the
/// places of the head are shifts. Heads stand at whole degrees here.
plan::ShiftDesign ShiftsOf(const Scenario& scenario) {
  const HobProcedureSettings& p = HobOf(scenario).hob_procedure;
  plan::ShiftDesign design;
  if (p.heads_rad.size() < 2) return design;
  design.positions = 360;
  for (const double head_rad : p.heads_rad)
    design.shifts.push_back(static_cast<int>(std::lround(head_rad / units::deg)));
  design.sets = [](const std::vector<int>& heads_deg) {
    return std::vector{fmt::format("hob_procedure.heads_deg=[{}]", fmt::join(heads_deg, ", "))};
  };
  design.words = "head at [deg]";
  return design;
}

}  // namespace twinbench::benches::hob
