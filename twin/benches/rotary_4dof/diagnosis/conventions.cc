#include "twin/benches/rotary_4dof/diagnosis/conventions.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "twin/benches/rotary_4dof/diagnosis/rotary_run.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/core/errors.h"
#include "twin/core/units.h"
#include "twin/diagnose/engine/scanner.h"

namespace twinbench::diagnose::rotary {
namespace {

void Exchange(Reading& r, std::size_t a, std::size_t b) {
  std::swap(r.mean_V[a], r.mean_V[b]);
  std::swap(r.std_V[a], r.std_V[b]);
}

/// Undoes one blunder in one reading.
void Undo(const std::string& where, double step_rad, Reading& r) {
  if (where == "swap_xy_a") Exchange(r, 0, 1);
  if (where == "swap_xy_b") Exchange(r, 2, 3);
  if (where == "swap_psds") {
    Exchange(r, 0, 2);
    Exchange(r, 1, 3);
  }
  for (std::size_t c = 0; c < kChannels; ++c) {
    if (where == std::string("negate_") + kChannelNames[c]) r.mean_V[c] = -r.mean_V[c];
  }
  if (where == "reverse_target") r.target_rad = -r.target_rad;
  if (where == "reverse_reference") r.reference_rad = -r.reference_rad;
  if (where == "index_offset") r.target_rad -= step_rad;
}

std::vector<Reading> Undone(const std::string& where, const Scenario& scenario, std::vector<Reading> readings) {
  const double step_rad = units::turn / RotaryOf(scenario).procedure.positions;
  for (Reading& r : readings) Undo(where, step_rad, r);
  return readings;
}

/// Share of the steps inside passes whose target turns as the direction says: 1 as it should be, 0 reversed.
double SenseOf(const std::vector<Reading>& readings) {
  int with = 0, all = 0;
  for (std::size_t i = 1; i < readings.size(); ++i) {
    const Reading &a = readings[i - 1], &b = readings[i];
    if (b.phase != Phase::kFullCircle || a.pass != b.pass || a.setup != b.setup) continue;
    ++all;
    if ((b.target_rad - a.target_rad) * b.direction > 0.0) ++with;
  }
  return all > 0 ? static_cast<double>(with) / all : 1.0;
}

/// Largest change of target + reference inside a set-up: it is a constant if both senses are right.
double SumSpread_rad(const std::vector<Reading>& readings) {
  double spread_rad = 0.0;
  for (std::size_t i = 1; i < readings.size(); ++i) {
    const Reading &a = readings[i - 1], &b = readings[i];
    if (a.phase != Phase::kFullCircle || b.phase != Phase::kFullCircle || a.setup != b.setup) continue;
    const double change_rad = b.target_rad + b.reference_rad - a.target_rad - a.reference_rad;
    spread_rad = std::max(spread_rad, std::abs(std::remainder(change_rad, units::turn)));
  }
  return spread_rad;
}

/// By how many steps target + reference differs from the shifts of the scenario, the same in all set-ups; 0 if not.
int IndexOffset(const std::vector<Reading>& readings, const Scenario& scenario) {
  const auto& shifts = RotaryOf(scenario).procedure.shifts;
  const int n = RotaryOf(scenario).procedure.positions;
  int offset = 0;
  bool first = true;
  for (const Reading& r : readings) {
    if (r.phase != Phase::kFullCircle || r.setup < 0 || r.setup >= std::ssize(shifts)) continue;
    const double steps =
        (r.target_rad + r.reference_rad) / units::turn * n - shifts[static_cast<std::size_t>(r.setup)];
    const int found = static_cast<int>(((std::lround(steps) % n) + n) % n);
    if (first) offset = found;
    first = false;
    if (found != offset) return 0;
  }
  return offset;
}

/// Which label is wrong, by bookkeeping alone.
std::string LabelBlunder(const std::vector<Reading>& readings, const Scenario& scenario) {
  const double step_rad = units::turn / RotaryOf(scenario).procedure.positions;
  if (SumSpread_rad(readings) > 0.1 * step_rad)
    return SenseOf(readings) < 0.5 ? "reverse_target" : "reverse_reference";
  return IndexOffset(readings, scenario) == 1 ? "index_offset" : "";
}

}  // namespace

ConventionResult ScreenConventions(const std::vector<Reading>& readings, const Scenario& scenario,
                                   const ForwardModel& model) {
  constexpr double kGross = 30.0;  // chi^2 per degree of freedom below which no wire is crossed
  constexpr double kCertain = 1e4;
  const std::string label = LabelBlunder(readings, scenario);
  if (!label.empty()) return {label, kCertain, Undone(label, scenario, readings)};
  const auto misfit_of = [&](const std::vector<Reading>& tried) {
    return FreeMisfit(BuildRun(tried, scenario, model).run);
  };
  const Misfit as_is = misfit_of(readings);
  if (as_is.power < kGross * as_is.degrees_of_freedom) return {"", 0.0, readings};
  ConventionResult best{"", 0.0, readings};
  for (const char* where : {"swap_xy_a", "swap_xy_b", "swap_psds", "negate_psd_a_x", "negate_psd_a_y",
                            "negate_psd_b_x", "negate_psd_b_y"}) {
    std::vector<Reading> undone = Undone(where, scenario, readings);
    const Misfit misfit = misfit_of(undone);
    // The noise scale is free: only the ratio of the misfits counts.
    const double log_evidence = 0.5 * as_is.degrees_of_freedom * std::log(as_is.power / misfit.power);
    if (log_evidence > best.log_evidence && misfit.power < 0.1 * as_is.power)
      best = {where, log_evidence, std::move(undone)};
  }
  return best;
}

}  // namespace twinbench::diagnose::rotary
