#include <algorithm>
#include <cmath>

#include "twin/benches/rotary_4dof/diagnose.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/core/units.h"
#include "twin/diagnose/conclusion.h"

namespace twinbench::benches::rotary {
namespace {

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

std::vector<diagnose::Cause> UndoLabelBlunder(const Scenario& scenario, std::vector<Reading>& readings) {
  constexpr double kCertain = 1e4;
  const std::string where = LabelBlunder(readings, scenario);
  if (where.empty()) return {};
  for (Reading& r : readings) {
    if (where == "reverse_target") r.target_rad = -r.target_rad;
    if (where == "reverse_reference") r.reference_rad = -r.reference_rad;
    if (where == "index_offset") r.target_rad -= units::turn / RotaryOf(scenario).procedure.positions;
  }
  return {diagnose::DecidedCause("convention", where, kCertain)};
}

}  // namespace twinbench::benches::rotary
