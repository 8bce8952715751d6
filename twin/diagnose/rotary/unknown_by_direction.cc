#include <fmt/format.h>

#include "twin/diagnose/rotary/signals.h"
#include "twin/diagnose/rotary/unknown_collector.h"

namespace twinbench::diagnose::rotary {
namespace {

/// @param angle_rad  Of the schedule, which the families keep a reference to.
void AddHarmonics(Collector& collect, const std::string& table, const Eigen::VectorXd& angle_rad) {
  constexpr int kOrders = 12;
  collect.Add(
      "direction harmonic", kOrders,
      [&angle_rad, direction = DirectionSignal(collect.schedule())](int g) {
        return Wave((g + 1) * angle_rad, direction);
      },
      [table](int g) {
        return fmt::format("direction times order {} of {} angle, odd in direction", g + 1, table);
      });
}

}  // namespace

void AddByDirection(Collector& collect) {
  const Schedule& s = collect.schedule();
  collect.Add("direction offset", DirectionSignal(s), "offset locked to direction (odd)");
  AddHarmonics(collect, "target", s.target_rad);
  AddHarmonics(collect, "reference", s.reference_rad);
}

}  // namespace twinbench::diagnose::rotary
