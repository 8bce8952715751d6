#include <cmath>
#include <nlohmann/json.hpp>

#include "twin/benches/rotary_4dof/estimators/harmonic_u.h"
#include "twin/benches/rotary_4dof/estimators/separate.h"
#include "twin/core/table_errors.h"
#include "twin/core/units.h"
#include "twin/core/written_number.h"

namespace twinbench::separate {
namespace {

using nlohmann::json;

json Column(const std::vector<double>& values, double unit) {
  json column = json::array();
  for (const double v : values) column.push_back(std::isfinite(v) ? json(WrittenNumber(v, unit)) : json(nullptr));
  return column;
}

/// Orders 1 to n/2, and of each component how well their amplitudes are known.
json HarmonicsJson(const TableEstimate& estimate) {
  json harmonics = {{"order", json::array()}};
  for (std::size_t k = 1; k <= estimate.value.position_rad.size() / 2; ++k) harmonics["order"].push_back(k);
  for (const Component c : estimate.components)
    harmonics[ColumnOf(c).name] = Column(HarmonicUncertainties(estimate, c), ColumnOf(c).to_SI);
  return harmonics;
}

json TableJson(const TableEstimate& estimate) {
  json table;
  table["position_deg"] = Column(estimate.value.position_rad, units::deg);
  for (const Component c : estimate.components) {
    table[ColumnOf(c).name] = Column(estimate.value[c], ColumnOf(c).to_SI);
    table["u_" + ColumnOf(c).name] = Column(estimate.u[c], ColumnOf(c).to_SI);
  }
  table["u_harmonics"] = HarmonicsJson(estimate);
  return table;
}

json ByMotion(const Vector4& values, bool with_units) {
  json object;
  for (int d = 0; d < measure::kDofs; ++d) {
    const Component c = kComponentOf[static_cast<std::size_t>(d)];
    const std::string key = with_units ? ColumnOf(c).name : kComponentNames[static_cast<std::size_t>(c)];
    if (std::isfinite(values[d])) object[key] = values[d] / (with_units ? ColumnOf(c).to_SI : 1.0);
  }
  return object;
}

json ClosureJson(const std::vector<Closure>& closure) {
  json list = json::array();
  for (const Closure& c : closure) {
    json entry = ByMotion(c.difference, true);
    entry["setup"] = c.setup;
    list.push_back(entry);
  }
  return list;
}

}  // namespace

json ToJson(const Separation& separation) {
  json out;
  out["estimator"] = EstimatorName(separation.estimator);
  out["target"] = TableJson(separation.target);
  out["reference"] = TableJson(separation.reference);
  out["not_separable"] = json::array();
  for (const NotSeparable& entry : separation.not_separable) {
    out["not_separable"].push_back({{"what", entry.what}, {"why", entry.why}});
  }
  out["residual_rms"] = ByMotion(separation.residual_rms, true);
  out["dof"] = separation.dof;
  out["chi2"] = ByMotion(separation.chi2, false);
  out["dof_of_motion"] = ByMotion(separation.dof_of, false);
  out["closure"] = ClosureJson(separation.closure);
  out["notes"] = separation.notes;
  return out;
}

}  // namespace twinbench::separate
