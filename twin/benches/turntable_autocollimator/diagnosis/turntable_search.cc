#include "twin/benches/turntable_autocollimator/diagnosis/turntable_search.h"

#include <algorithm>
#include <limits>

#include "twin/benches/turntable_autocollimator/diagnosis/families.h"
#include "twin/benches/turntable_autocollimator/diagnosis/outliers.h"
#include "twin/benches/turntable_autocollimator/diagnosis/seating.h"
#include "twin/benches/turntable_autocollimator/settings.h"
#include "twin/core/effect_catalogue.h"
#include "twin/core/units.h"

namespace twinbench::diagnose::turntable {
namespace {

constexpr const char* kRipple = "autocollimator_periodic";

/// The ripples that were found, as blocks of a scenario.
std::vector<EffectSettings> RipplesOf(const SearchedTurntable& searched) {
  std::vector<EffectSettings> ripples;
  for (const Term& term : searched.analysis.found.terms) {
    const Family& family = (*searched.families)[static_cast<std::size_t>(term.family)];
    if (family.effect != kRipple) continue;
    EffectSettings ripple{.name = family.effect, .where = family.where, .parameters = {}, .location = ""};
    for (const ParameterEstimate& p : family.parameters(term.shape, term.amplitudes, term.cov))
      ripple.parameters[p.name] = p.value;
    ripples.push_back(std::move(ripple));
  }
  return ripples;
}

/// The steepest slope of a ripple: by this share the prediction is shifted where its unknowns absorb the ripple.
double SteepestSlope(const std::vector<EffectSettings>& ripples) {
  double steepest = 0.0;
  for (const EffectSettings& r : ripples)
    steepest = std::max(steepest, 2.0 * units::kPi * r.parameters.at("amplitude") / r.parameters.at("period"));
  return steepest;
}

/// @param options  With the thresholds of a design that is the same but for its unknowns, if they are known.
void Analyse(std::unique_ptr<TurntableRun> turntable, const std::vector<std::string>& excluded,
             const AnalysisOptions& options, SearchedTurntable& searched) {
  searched.turntable = std::move(turntable);
  LinearRun& run = searched.turntable->run;
  for (const int row : searched.outlying ? searched.outlying->outliers : std::vector<int>{})
    run.sigma[row] = searched.outlying->repaired.sigma[row];
  searched.families = std::make_unique<std::vector<Family>>(Families(*searched.turntable, excluded));
  searched.analysis = diagnose::Analyse(run, *searched.families, options);
}

/// The same with amplitudes that fit best in the exact model: a steep ripple that was found where the prediction
/// had already followed it is too small or too large.
std::vector<EffectSettings> Rescaled(const std::vector<EffectSettings>& ripples,
                                     const std::vector<Reading>& readings, const Scenario& scenario,
                                     const model::FollowMaker& follow) {
  std::vector<EffectSettings> best = ripples;
  double least = std::numeric_limits<double>::infinity();
  for (const double factor : {0.35, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.25, 1.45}) {
    std::vector<EffectSettings> scaled = ripples;
    for (EffectSettings& ripple : scaled) ripple.parameters.at("amplitude") *= factor;
    Scenario with_scaled = scenario;
    with_scaled.effects.insert(with_scaled.effects.end(), scaled.begin(), scaled.end());
    const double power = FreeMisfit(BuildRun(readings, with_scaled, follow).run).power;
    if (power >= least) continue;
    least = power;
    best = scaled;
  }
  return best;
}

void FollowRipples(const std::vector<Reading>& readings, const Scenario& scenario, const model::FollowMaker& follow,
                   const std::vector<std::string>& excluded, const AnalysisOptions& options,
                   SearchedTurntable& searched) {
  constexpr double kSlight = 0.1;
  constexpr int kMostRounds = 3;
  for (int round = 0; round < kMostRounds; ++round) {
    const std::vector<EffectSettings> ripples = RipplesOf(searched);
    if (SteepestSlope(ripples) < kSlight) return;
    const std::vector<EffectSettings> rescaled = Rescaled(ripples, readings, scenario, follow);
    Analyse(std::make_unique<TurntableRun>(LinearisedAbout(rescaled, readings, scenario, follow)), excluded,
            options, searched);
  }
}

SearchedTurntable Search(const std::vector<Reading>& readings, const Scenario& scenario,
                         const model::FollowMaker& follow, const std::vector<std::string>& excluded,
                         AnalysisOptions options) {
  const auto is_struck = [&](const char* effect) { return std::ranges::find(excluded, effect) != excluded.end(); };
  SearchedTurntable searched;
  auto first = std::make_unique<TurntableRun>(BuildRun(readings, scenario, follow));
  if (!options.design_only && !is_struck("outliers")) searched.outlying = FindOutliers(first->run);
  Analyse(std::move(first), excluded, options, searched);
  const NullCalibration null = searched.analysis.null;
  options.null = &null;
  FollowRipples(readings, scenario, follow, excluded, options, searched);
  if (TurntableOf(scenario).HasPolygon()) return searched;  // nothing is lifted and seated again
  const TurntableRun stated = *searched.turntable;
  const Seating seating = MeasureSeating(stated, searched.analysis);
  searched.smallest_seating_rad = seating.smallest_rad;
  // What is not known of the argument of a steep ripple scatters, too.
  const double by_ripple_rad = SteepestSlope(RipplesOf(searched)) * UsualSigma_rad(stated.run);
  if (!(seating.log_bayes > kSeated) || seating.scatter_rad < by_ripple_rad || is_struck("multitooth_seating"))
    return searched;
  auto louder = std::make_unique<TurntableRun>(stated);
  louder->run = WithScatter(stated, seating.scatter_rad);
  Analyse(std::move(louder), excluded, options, searched);
  searched.first = {SeatingCause(MeasureSeating(stated, searched.analysis))};
  return searched;
}

}  // namespace

SearchedTurntable SearchTurntable(const std::vector<Reading>& readings, const Scenario& scenario,
                                  const std::vector<std::string>& excluded, const AnalysisOptions& options,
                                  const model::FollowMaker& follow) {
  SearchedTurntable searched = Search(readings, scenario, follow, excluded, options);
  if (searched.outlying) TakeFurther(searched.analysis, *searched.outlying);
  return searched;
}

}  // namespace twinbench::diagnose::turntable
