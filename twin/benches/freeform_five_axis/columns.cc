#include "twin/benches/freeform_five_axis/columns.h"

#include "twin/benches/freeform_five_axis/format.h"
#include "twin/core/units.h"

namespace twinbench::benches::freeform {
namespace {

/// Readings of displacements have none.
ReadingColumn OfProbe(const char* name, const char* unit, const Quantity& quantity) {
  ReadingColumn column = ShownColumn(name, 1.0, unit, quantity);
  column.may_be_absent = true;
  return column;
}

}  // namespace

std::vector<ReadingColumn> Columns() {
  std::vector<ReadingColumn> own;
  for (std::size_t axis = 0; axis < kCommanded.size(); ++axis)
    own.push_back(NumberColumn(kCommanded[axis].column, axis < 3 ? units::mm : units::deg, ColumnRole::kRequired,
                               kCommanded[axis]));
  own.push_back(NumberColumn("cell_i", 1.0, ColumnRole::kRequired, kCellI));
  own.push_back(NumberColumn("cell_j", 1.0, ColumnRole::kRequired, kCellJ));
  own.push_back(OfProbe("qpd_x_V", "V", kQpdX_V));
  own.push_back(OfProbe("qpd_y_V", "V", kQpdY_V));
  own.push_back(NumberColumn("qpd_sum_V", 1.0, ColumnRole::kShownToo, kQpdSum_V));
  own.push_back(OfProbe("ccd_px", "px", kCcd_px));
  own.push_back(NumberColumn(kCommandedC.column, units::deg, ColumnRole::kOptional, kCommandedC));
  for (const Quantity& shift : kShift_m)
    own.push_back(NumberColumn(shift.column, units::um, ColumnRole::kShownToo, shift));
  own.push_back(NumberColumn(
      "temperature_degC", 1.0, ColumnRole::kOptional, [](auto& r) -> auto& { return r.temperature_degC; }));
  return Joined({CommonColumns(false), own});
}

std::vector<DesiredColumn> Desired() {
  return {{"temperature_degC", [](const Reading& r) { return std::isfinite(r.temperature_degC); },
           "growth with the temperature cannot be seen"}};
}

}  // namespace twinbench::benches::freeform
