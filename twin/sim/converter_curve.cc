#include "twin/sim/converter_curve.h"

#include <algorithm>

#include "twin/core/csv.h"
#include "twin/core/errors.h"
#include "twin/core/units.h"

namespace twinbench::sim {

ConverterCurve::ConverterCurve(const std::string& path) {
  if (path.empty()) return;
  const CsvTable table = ReadCsv(path);
  const auto voltage = table.Column("voltage_V"), error = table.Column("error_mV");
  if (!voltage || !error) throw InputError(table.WhereHeader(), "a column is missing", "voltage_V and error_mV");
  for (const CsvTable::Row& row : table.rows) {
    const double voltage_V = CsvNumber(table, row, *voltage, 1.0);
    if (!voltage_V_.empty() && voltage_V <= voltage_V_.back())
      throw InputError(table.Where(row), "voltage_V does not increase", "rows in its order");
    voltage_V_.push_back(voltage_V);
    added_V_.push_back(CsvNumber(table, row, *error, units::mV));
  }
  if (voltage_V_.empty()) throw InputError(table.name, "holds no rows", "rows of voltage_V and error_mV");
}

double ConverterCurve::Added_V(double voltage_V) const {
  if (voltage_V_.empty()) return 0.0;
  const auto after = std::ranges::upper_bound(voltage_V_, voltage_V);
  if (after == voltage_V_.begin()) return added_V_.front();
  if (after == voltage_V_.end()) return added_V_.back();
  const auto k = static_cast<std::size_t>(after - voltage_V_.begin());
  const double share = (voltage_V - voltage_V_[k - 1]) / (voltage_V_[k] - voltage_V_[k - 1]);
  return added_V_[k - 1] + share * (added_V_[k] - added_V_[k - 1]);
}

}  // namespace twinbench::sim
