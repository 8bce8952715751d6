#include "twin/benches/turntable_autocollimator/diagnosis/turntable_search.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <utility>

#include "twin/benches/turntable_autocollimator/diagnosis/families.h"
#include "twin/benches/turntable_autocollimator/diagnosis/outliers.h"
#include "twin/benches/turntable_autocollimator/diagnosis/seating.h"
#include "twin/benches/turntable_autocollimator/settings.h"
#include "twin/core/effect_catalogue.h"
#include "twin/core/units.h"
#include "twin/diagnose/engine/answer.h"

namespace twinbench::diagnose::turntable {
namespace {

constexpr const char* kRipple = "autocollimator_periodic";

EffectSettings RippleOf(const Family& family, const Eigen::VectorXd& shape, const Eigen::VectorXd& amplitudes,
                        const Eigen::MatrixXd& cov) {
  EffectSettings ripple{.name = family.effect, .where = family.where, .parameters = {}, .location = ""};
  for (const ParameterEstimate& p : ParametersOf(family, shape, amplitudes, cov)) ripple.parameters[p.name] = p.value;
  return ripple;
}

/// The ripples that were found, as blocks of a scenario.
std::vector<EffectSettings> RipplesOf(const SearchedTurntable& searched) {
  std::vector<EffectSettings> ripples;
  for (const Term& term : searched.analysis.found.terms) {
    const Family& family = (*searched.families)[static_cast<std::size_t>(term.family)];
    if (family.effect == kRipple) ripples.push_back(RippleOf(family, term.shape, term.amplitudes, term.cov));
  }
  return ripples;
}

/// The same ripple at periods that explain nearly as much: where stops are few, one period looks like another, and how
/// steep it is decides.
std::vector<EffectSettings> AliasesOf(const EffectSettings& ripple, const SearchedTurntable& searched) {
  constexpr double kNearly = 0.7;
  constexpr std::size_t kMost = 5;
  const Analysis& analysis = searched.analysis;
  const Eigen::MatrixXd residual = searched.turntable->run.residual;
  const Projected data =
      Project(*analysis.projector, {}, analysis.noise.Whiten(searched.turntable->run, residual));
  std::vector<std::pair<double, EffectSettings>> maxima;
  double most = 0.0;
  for (int k = 0; k < std::ssize(*searched.families); ++k) {
    const Family& family = (*searched.families)[static_cast<std::size_t>(k)];
    if (family.effect != kRipple || family.where != ripple.where) continue;
    const std::vector<Scanner::Fit> fits = analysis.scanner->FitEach(k, 0, family.grid - 1, data, {});
    for (std::size_t g = 0; g < fits.size(); ++g) {
      const bool is_maximum = (g == 0 || fits[g].power >= fits[g - 1].power) &&
                              (g + 1 == fits.size() || fits[g].power > fits[g + 1].power);
      most = std::max(most, fits[g].power);
      const Eigen::MatrixXd unknown = Eigen::MatrixXd::Identity(2, 2);
      if (is_maximum)
        maxima.emplace_back(fits[g].power,
                            RippleOf(family, family.ShapeAt(static_cast<int>(g)), fits[g].amplitudes, unknown));
    }
  }
  std::erase_if(maxima, [most](const auto& maximum) { return maximum.first < kNearly * most; });
  std::ranges::stable_sort(maxima, std::ranges::greater{}, &std::pair<double, EffectSettings>::first);
  std::vector<EffectSettings> aliases = {ripple};
  for (std::size_t k = 0; k < std::min(kMost, maxima.size()); ++k) aliases.push_back(maxima[k].second);
  return aliases;
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

/// The same with the period and the amplitude of each that fit best in the exact model: a steep ripple that was found
/// where the prediction had already followed it is too small or too large.
std::vector<EffectSettings> Refitted(const std::vector<EffectSettings>& ripples, const SearchedTurntable& searched,
                                     const std::vector<Reading>& readings, const Scenario& scenario,
                                     const model::FollowMaker& follow) {
  constexpr double kRunsBackwards = 1.0;  // no camera's readings do
  std::vector<EffectSettings> best = ripples;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < ripples.size(); ++k) {
    const std::vector<EffectSettings> before = best;
    for (const EffectSettings& alias : AliasesOf(ripples[k], searched)) {
      for (const double factor : {0.35, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.25, 1.45}) {
        std::vector<EffectSettings> tried = before;
        tried[k] = alias;
        tried[k].parameters.at("amplitude") *= factor;
        if (SteepestSlope(tried) >= kRunsBackwards) continue;
        Scenario with_tried = scenario;
        with_tried.effects.insert(with_tried.effects.end(), tried.begin(), tried.end());
        const double power = FreeMisfit(BuildRun(readings, with_tried, follow).run).power;
        if (power >= least) continue;
        least = power;
        best = tried;
      }
    }
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
    const std::vector<EffectSettings> refitted = Refitted(ripples, searched, readings, scenario, follow);
    Analyse(std::make_unique<TurntableRun>(LinearisedAbout(refitted, readings, scenario, follow)), excluded,
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
