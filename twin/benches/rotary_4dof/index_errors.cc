#include "twin/separate/index_errors.h"

#include <cmath>

#include "twin/benches/rotary_4dof/analysis.h"
#include "twin/benches/rotary_4dof/bench.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/core/errors.h"

namespace twinbench::benches::rotary {

separate::IndexErrors IndexErrorsOf(const Scenario& scenario, const std::vector<Reading>& readings) {
  const Analysis analysis = Analyse(scenario, readings, Estimator::kRigorous);
  if (!analysis.separation) throw InputError("readings", analysis.not_separated, "readings of a full-circle test");
  const separate::TableEstimate& target = analysis.separation->target;
  const std::vector<double>&ez_rad = target.value[Component::kEz], &u_rad = target.u[Component::kEz];
  std::vector<separate::IndexReading> values;
  double squares_rad2 = 0.0;
  for (std::size_t i = 0; i < ez_rad.size(); ++i) {
    values.push_back({0, target.value.position_rad[i], ez_rad[i]});
    if (std::isfinite(ez_rad[i])) squares_rad2 += u_rad[i] * u_rad[i];
  }
  separate::IndexErrors errors = separate::MeansByPlace(values);
  // A place is the mean of all set-ups and passes already: one value of the uncertainty that the separation states.
  errors.u_reading_rad = std::sqrt(squares_rad2 / static_cast<double>(errors.Count()));
  errors.dof = analysis.separation->dof_of[0];
  errors.table = "target";
  errors.commanded = RotaryOf(scenario).target.compensation;
  return errors;
}

}  // namespace twinbench::benches::rotary
