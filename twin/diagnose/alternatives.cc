#include "twin/diagnose/alternatives.h"

#include <cmath>
#include <optional>
#include <utility>

#include "twin/diagnose/conclusion.h"
#include "twin/diagnose/engine/estimate.h"

namespace twinbench::diagnose {
namespace {

Scenario With(Scenario scenario, const Alternative& alternative) {
  scenario.effects.push_back({alternative.effect, alternative.where, {}, ""});
  return scenario;
}

}  // namespace

Belief BelieveIn(const std::vector<Reading>& readings, const Scenario& scenario, const ComparisonOf& comparison_of,
                 const std::vector<Cause>& decided) {
  TwinComparison comparison = comparison_of(scenario);
  Compared compared = Compare(readings, scenario, comparison);
  const Misfit misfit = FreeMisfit(compared.run);
  return {scenario, std::move(comparison), std::move(compared), misfit, decided};
}

Belief WithoutBlunder(const std::vector<Reading>& readings, const ComparisonOf& comparison_of,
                      const std::vector<Alternative>& alternatives, Belief stated) {
  constexpr double kGross = 30.0;  // chi^2 per degree of freedom below which no wire is crossed
  const Misfit as_is = stated.misfit;
  if (as_is.power < kGross * as_is.degrees_of_freedom) return stated;
  std::optional<Belief> best;
  for (const Alternative& a : alternatives) {
    if (!a.is_gross) continue;
    Belief tried = BelieveIn(readings, With(stated.scenario, a), comparison_of, stated.decided);
    if (tried.misfit.power > 0.1 * as_is.power || (best && tried.misfit.power >= best->misfit.power)) continue;
    const double evidence = 0.5 * as_is.degrees_of_freedom * std::log(as_is.power / tried.misfit.power);
    tried.decided.push_back(DecidedCause(a.effect, a.where, evidence));
    best = std::move(tried);
  }
  return best ? std::move(*best) : std::move(stated);
}

std::unique_ptr<Searched> SearchAlternatives(const std::vector<Reading>& readings, const DiagnoseOptions& options,
                                             const ComparisonOf& comparison_of,
                                             const std::vector<Alternative>& alternatives, Belief& belief) {
  constexpr double kWorthTrying = 10.0;
  const auto search = [&](Belief& in) {
    return SearchIn(readings, in.scenario, options, in.comparison, std::move(in.compared));
  };
  const Misfit stated = belief.misfit;
  const int rows = belief.compared.run.Rows();
  std::unique_ptr<Searched> searched;
  double most = 0.0;
  for (const Alternative& a : alternatives) {
    if (a.is_gross) continue;
    Belief other = BelieveIn(readings, With(belief.scenario, a), comparison_of, belief.decided);
    const double evidence = 0.5 * rows * std::log(stated.power / other.misfit.power);
    if (evidence < kWorthTrying) continue;
    auto in_other = search(other);
    other.decided.push_back(DecidedCause(a.effect, a.where, evidence));
    if (!searched) {
      if (in_other->found().terms.empty()) {
        belief = std::move(other);
        return in_other;
      }
      searched = search(belief);
      most = searched->found().joint_evidence;
    }
    if (evidence + in_other->found().joint_evidence <= most) continue;
    most = evidence + in_other->found().joint_evidence;
    searched = std::move(in_other);
    belief = std::move(other);
  }
  return searched ? std::move(searched) : search(belief);
}

}  // namespace twinbench::diagnose
