#include <cmath>

#include "twin/benches/hob_transmission/format.h"
#include "twin/core/reading_column.h"
#include "twin/core/units.h"

namespace twinbench::benches::hob {

std::vector<ReadingColumn> Columns() {
  std::vector<ReadingColumn> own = {
      ShownColumn(
          "table_encoder_deg", units::deg, "deg", [](auto& r) -> auto& { return r.measured_rad; }),
      ShownColumn(
          "hob_encoder_deg", units::deg, "deg", [](auto& r) -> auto& { return r.reference_rad; }),
      NumberColumn(
          "head_deg", units::deg, ColumnRole::kRequired, [](auto& r) -> auto& { return r.head_rad; }),
      NumberColumn(
          "interferometer_arcsec", units::arcsec, ColumnRole::kShownToo,
          [](auto& r) -> auto& { return r.interferometer_rad; }),
      NumberColumn(
          "velocity_deg_s", units::deg, ColumnRole::kOptional, [](auto& r) -> auto& { return r.velocity_rad_s; })};
  return Joined({CommonColumns(true), own, ConditionColumns()});
}

std::vector<DesiredColumn> Desired() {
  return {{"velocity_deg_s", [](const Reading& r) { return std::isfinite(r.velocity_rad_s); },
           "latency is judged by speeds from the table encoder's own angles and times"},
          {"interferometer_arcsec", [](const Reading& r) { return std::isfinite(r.interferometer_rad); },
           "hob_runout and gear_mesh look like eccentricity and ellipticity of the hob's encoder, backlash at one "
           "speed like latency"}};
}

std::string Addition(int /*setups*/) {
  return "the way back, as in hob_procedure.passes = [1, -1]; or another place of the reading head, as in "
         "hob_procedure.heads_deg = [0, 180]";
}

}  // namespace twinbench::benches::hob
