#include "twin/diagnose/by_twin.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <utility>

#include "twin/diagnose/about_first_cause.h"
#include "twin/diagnose/conclusion.h"
#include "twin/diagnose/engine/estimate.h"
#include "twin/diagnose/scatter_cause.h"
#include "twin/diagnose/searched.h"
#include "twin/diagnose/to_readings.h"

namespace twinbench::diagnose {
namespace {

/// What is believed of a record, how well it fits, and what was decided to come there.
struct Belief {
  Scenario scenario;
  TwinComparison comparison;
  Compared compared;
  Misfit misfit;
  std::vector<Cause> decided;
};

Scenario With(Scenario scenario, const Alternative& alternative) {
  scenario.effects.push_back({alternative.effect, alternative.where, {}, ""});
  return scenario;
}

Belief BelieveIn(const std::vector<Reading>& readings, const Scenario& scenario, const ComparisonOf& comparison_of,
                 const std::vector<Cause>& decided) {
  TwinComparison comparison = comparison_of(scenario);
  Compared compared = Compare(readings, scenario, comparison);
  const Misfit misfit = FreeMisfit(compared.run);
  return {scenario, std::move(comparison), std::move(compared), misfit, decided};
}

/// The one that leaves least, if it leaves next to nothing. The noise scale is free: only the ratio of the misfits
/// counts.
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

/// The search in what is believed, or in the alternative that explains more with all that was found in it. That it
/// has fewer unknowns is not counted in its favour.
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

/// What stands in for an effect that a run does not show: the largest constant of a free point.
struct Bias {
  double trace;  // norm of what it shows in the readings, in units of their noise
  std::string words;
};

/// "zero of a set-up up to 0.3 um": those that show most first, and nothing of what shows next to nothing.
std::string BiasOf(const LinearRun& run, const FreeConstants& free, const Eigen::VectorXd& fitted) {
  constexpr std::size_t kMostTold = 4;
  constexpr double kLeastShown = 0.01;  // of the one that shows most
  const Eigen::VectorXd constants = free.fitted * fitted.head(free.fitted.cols());
  const Eigen::VectorXd trace = (run.sigma.cwiseInverse().asDiagonal() * free.columns)
                                    .colwise()
                                    .norm()
                                    .transpose()
                                    .cwiseProduct(constants.cwiseAbs());
  std::vector<Bias> told;
  Eigen::Index from = 0;
  free.ForEach(constants, [&](const FreePoint& p, const auto& own) {
    told.push_back({trace.segment(from, own.size()).maxCoeff(),
                    fmt::format("{} of {} up to {:.2g} {}", p.point.name, p.of, own.cwiseAbs().maxCoeff() / p.point.to_SI,
                                p.point.unit)});
    from += own.size();
  });
  if (told.empty()) return "nothing: the run leaves nothing free";
  std::ranges::stable_sort(told, std::greater(), &Bias::trace);
  std::erase_if(told, [most = told.front().trace](const Bias& b) { return b.trace < kLeastShown * most; });
  const bool too_many = told.size() > 2 * kMostTold;
  if (too_many) told.resize(kMostTold);
  std::string words;
  for (const Bias& b : told) words += (words.empty() ? "" : ", ") + b.words;
  return too_many ? words + " and others" : words;
}

std::string NextOf(const std::string& effect, const std::string& rival) {
  return fmt::format(
      "the same run on another path (more passes in both directions, other dwells, a further "
      "mounting), chosen so that {} and {} go different ways",
      effect, rival);
}

/// What scatters more than stated is noise that is known from then on, and the search begins again.
/// @param detectable  Gets how small it would have been seen where there is none.
std::vector<Cause> FindScatter(const DiagnoseOptions& options, const TwinComparison& comparison, Searched& searched,
                               std::vector<Detectable>& detectable) {
  if (!comparison.scatter_cause || options.design_only || IsExcluded(options, comparison.scatter_cause->effect))
    return {};
  const Compared& c = searched.compared;
  const LinearRun stated = c.run;
  const Eigen::VectorXd slope = c.Rows(c.twin.Slope(comparison.scatter_cause->point, c.free.Disturbances()));
  const Scattering found = MeasureScatter(stated, searched.analysis, slope);
  if (!found.IsThere()) {
    if (std::isfinite(found.smallest)) detectable.push_back(DetectableOf(found, comparison));
    return {};
  }
  LinearRun& run = searched.compared.run;
  run.sigma = (run.sigma.cwiseAbs2() + (found.sd * slope).cwiseAbs2()).cwiseSqrt();
  AnalysisOptions how = HowToAnalyse(run, options, comparison);
  const NullCalibration null = searched.analysis.null;
  how.null = &null;
  searched.analysis = Analyse(run, searched.candidates.families, how);
  return {CauseOf(MeasureScatter(stated, searched.analysis, slope), comparison)};
}

DiagnosisRun ConcludeOf(std::unique_ptr<Searched> searched, const std::vector<Reading>& readings,
                        const DiagnoseOptions& options, const TwinComparison& comparison,
                        std::vector<Cause> first) {
  if (auto again = SearchedAboutFirst(*searched, readings, options, comparison)) searched = std::move(again);
  std::vector<Detectable> detectable;
  std::ranges::move(FindScatter(options, comparison, *searched, detectable), std::back_inserter(first));
  const Compared& c = searched->compared;
  std::ranges::move(OutliersLeftOut(c, comparison, options.excluded), std::back_inserter(first));
  DiagnosisRun result = Conclude(c.run, searched->analysis, first,
                                 {[&](const std::string& effect, const Eigen::VectorXd& x) {
                                    const std::string bias = BiasOf(c.run, c.free, x);
                                    const std::string by = comparison.shown_by ? comparison.shown_by(effect) : "";
                                    return by.empty() ? bias : bias + "; would be shown by " + by;
                                  },
                                  comparison.next_measurement ? comparison.next_measurement : NextOf});
  std::ranges::copy(detectable, std::back_inserter(result.diagnosis.detectable));
  std::ranges::copy(searched->candidates.invisible, std::back_inserter(result.diagnosis.invisible));
  result.diagnosis.left_out = static_cast<int>(readings.size() - c.used.size() - c.outliers.readings.size());
  if (comparison.sampled) ToReadings(c, comparison, result);
  return result;
}

}  // namespace

LinearRun CompareWithTwin(const std::vector<Reading>& readings, const Scenario& scenario,
                          const TwinComparison& comparison) {
  return Compare(readings, scenario, comparison).run;
}

DiagnosisRun DiagnoseByTwin(const std::vector<Reading>& readings, const Scenario& scenario,
                            const DiagnoseOptions& options, const TwinComparison& comparison) {
  return ConcludeOf(SearchIn(readings, scenario, options, comparison, Compare(readings, scenario, comparison)),
                    readings, options, comparison, {});
}

DiagnosisRun DiagnoseByTwin(const std::vector<Reading>& readings, const Scenario& scenario,
                            const DiagnoseOptions& options, const ComparisonOf& comparison_of,
                            const std::vector<Alternative>& alternatives, const std::vector<Cause>& decided) {
  std::vector<Alternative> worth = alternatives;
  std::erase_if(worth, [&](const Alternative& a) { return IsExcluded(options, a.effect); });
  Belief belief = WithoutBlunder(readings, comparison_of, worth,
                                 BelieveIn(readings, scenario, comparison_of, decided));
  std::unique_ptr<Searched> searched = SearchAlternatives(readings, options, comparison_of, worth, belief);
  return ConcludeOf(std::move(searched), readings, options, belief.comparison, belief.decided);
}

}  // namespace twinbench::diagnose
