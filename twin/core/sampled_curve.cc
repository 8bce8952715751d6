#include "twin/core/sampled_curve.h"

#include <algorithm>
#include <functional>

#include "twin/core/csv.h"
#include "twin/core/errors.h"

namespace twinbench {

SampledCurve::SampledCurve(std::vector<double> at, std::vector<double> value)
    : at_(std::move(at)), value_(std::move(value)) {
  Require(at_.size() == value_.size(), "a curve has one value a place");
  Require(std::ranges::adjacent_find(at_, std::greater_equal<>()) == at_.end(), "a curve's places increase");
}

double SampledCurve::At(double place) const {
  const auto after = std::ranges::upper_bound(at_, place);
  if (after == at_.begin()) return value_.front();
  if (after == at_.end()) return value_.back();
  const auto k = static_cast<std::size_t>(after - at_.begin());
  const double share = (place - at_[k - 1]) / (at_[k] - at_[k - 1]);
  return value_[k - 1] + share * (value_[k] - value_[k - 1]);
}

SampledCurve ReadSampledCurve(const std::string& path, const CurveColumn& at, const CurveColumn& value) {
  const std::string both = at.name + " and " + value.name;
  const CsvTable table = ReadCsv(path);
  const std::size_t at_column = NeededColumn(table, at.name, both), value_column = NeededColumn(table, value.name, both);
  std::vector<double> places, values;
  for (const CsvTable::Row& row : table.rows) {
    const double place = CsvNumber(table, row, at_column, at.to_SI);
    if (!places.empty() && place <= places.back())
      throw InputError(table.Where(row), at.name + " does not increase", "rows in its order");
    places.push_back(place);
    values.push_back(CsvNumber(table, row, value_column, value.to_SI));
  }
  if (places.empty()) throw InputError(table.name, "holds no rows", "rows of " + both);
  return {std::move(places), std::move(values)};
}

}  // namespace twinbench
