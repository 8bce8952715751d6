#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/benches/encoder_comparison/format.h"
#include "twin/core/reading_column.h"
#include "twin/core/units.h"

namespace twinbench::benches::encoder {

std::vector<ReadingColumn> Columns() {
  const std::vector<ReadingColumn> angles = {
      NumberColumn(
          "reference_deg", units::deg, ColumnRole::kRequired, [](auto& r) -> auto& { return r.reference_rad; }),
      ShownColumn(
          "measured_deg", units::deg, "deg", [](auto& r) -> auto& { return r.measured_rad; }),
      NumberColumn(
          "velocity_deg_s", units::deg, ColumnRole::kOptional, [](auto& r) -> auto& { return r.velocity_rad_s; }),
      NumberColumn(
          "head_deg", units::deg, ColumnRole::kOptional, [](auto& r) -> auto& { return r.head_rad; }),
      NumberColumn("stamp_s", 1.0, ColumnRole::kOptional, Quantity{"stamp_s"})};
  return Joined({CommonColumns(true), angles, ConditionColumns()});
}

std::vector<DesiredColumn> Desired() {
  return {{"velocity_deg_s", [](const Reading& r) { return std::isfinite(r.velocity_rad_s); },
           "latency is judged by speeds from the reference's own angles and times, and at rest not at all"},
          {"temperature_degC", [](const Reading& r) { return std::isfinite(r.temperature_degC); },
           "a drift cannot be tied to the temperature"}};
}

ComparedColumns Compared() {
  return {"reference_deg", "measured_deg", "velocity_deg_s", [](const ImportedCourse& course) {
            std::vector<std::string> set = {
                fmt::format("encoder_procedure.kind={}", course.stops ? "stops" : "sweep"),
                fmt::format("encoder_procedure.turns={:.6g}", std::clamp(course.turns, 1e-3, 1000.0))};
            if (course.turn_m > 0.0)
              set.push_back(fmt::format("device.turn_mm={:.17g}", course.turn_m / units::mm));
            return set;
          }};
}

std::string Addition(int /*setups*/) {
  return "a second turn and the way back, as in encoder_procedure.turns = 2.0 and encoder_procedure.passes = [1, "
         "-1]";
}

}  // namespace twinbench::benches::encoder
