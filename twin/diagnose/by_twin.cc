#include "twin/diagnose/by_twin.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "twin/core/units.h"
#include "twin/diagnose/compared.h"
#include "twin/diagnose/conclusion.h"
#include "twin/diagnose/engine/analysis.h"
#include "twin/diagnose/scatter_cause.h"
#include "twin/diagnose/to_readings.h"
#include "twin/diagnose/twin_candidates.h"

namespace twinbench::diagnose {
namespace {

/// "zero of a set-up up to 0.3 um": the largest constant of each free point; of many points those that show most.
std::string BiasOf(const LinearRun& run, const FreeConstants& free, const Eigen::VectorXd& fitted) {
  constexpr std::size_t kMostTold = 4;
  const Eigen::VectorXd constants = free.fitted * fitted.head(free.fitted.cols());
  const Eigen::VectorXd trace = (run.sigma.cwiseInverse().asDiagonal() * free.columns)
                                    .colwise()
                                    .norm()
                                    .transpose()
                                    .cwiseProduct(constants.cwiseAbs());
  std::vector<std::pair<double, std::string>> told;
  Eigen::Index from = 0;
  free.ForEach(constants, [&](const FreePoint& p, const auto& own) {
    told.emplace_back(-trace.segment(from, own.size()).maxCoeff(),
                      fmt::format("{} of {} up to {:.2g} {}", p.point.name, p.of,
                                  own.cwiseAbs().maxCoeff() / p.point.to_SI, p.point.unit));
    from += own.size();
  });
  const bool too_many = told.size() > 2 * kMostTold;
  if (too_many) {
    std::ranges::stable_sort(told, {}, &std::pair<double, std::string>::first);
    told.resize(kMostTold);
  }
  std::string words;
  for (const auto& [trace_of_it, text] : told) words += (words.empty() ? "" : ", ") + text;
  if (words.empty()) return "nothing: the run leaves nothing free";
  return too_many ? words + " and others" : words;
}

/// Simulated runs without effect: fewer where a run has many rows.
int NullRuns(const LinearRun& run, int wanted) {
  constexpr int kFewest = 150;
  constexpr double kRows = 1e6;  // of all simulated runs
  return std::min(wanted, std::max(static_cast<int>(kRows / run.Rows()), kFewest));
}

AnalysisOptions HowToAnalyse(const LinearRun& run, const DiagnoseOptions& options,
                             const TwinComparison& comparison) {
  AnalysisOptions how = AnalysisOptionsOf(options);
  how.most_causes = comparison.most_causes;
  if (comparison.sampled) how.null_runs = NullRuns(run, options.null_runs);
  return how;
}

std::string NextOf(const std::string& effect, const std::string& rival) {
  return fmt::format(
      "the same run on another path (more passes in both directions, other dwells, a further "
      "mounting), chosen so that {} and {} go different ways",
      effect, rival);
}

/// A record compared with the twin of one scenario, and what the search makes of it.
struct Searched {
  Searched(const std::vector<Reading>& readings, const Scenario& believed, const DiagnoseOptions& options,
           const TwinComparison& comparison, Compared with_its_twin)
      : scenario(believed),
        compared(std::move(with_its_twin)),
        candidates(CandidatesOf(compared, readings, scenario, options, comparison)) {}
  Searched(const Searched&) = delete;
  Searched& operator=(const Searched&) = delete;

  const SearchResult& found() const { return analysis.found; }
  const Family& FamilyOf(const Term& term) const {
    return candidates.families[static_cast<std::size_t>(term.family)];
  }
  /// More than the first cause is needed, or something is left.
  bool LeavesStructure() const {
    return found().terms.size() > 1 || (!found().terms.empty() && found().last_statistic > analysis.threshold);
  }

  Scenario scenario;
  Compared compared;
  TwinCandidates candidates;
  Analysis analysis;
};

/// The cause that was found first as the twin can carry it out.
EffectSettings EffectOf(const Family& family, const Term& term, const std::vector<EffectEntry>& catalogue) {
  EffectSettings effect;
  effect.name = family.effect;
  effect.where = family.where;
  const EffectEntry& entry = *std::ranges::find(catalogue, family.effect, &EffectEntry::name);
  for (const EffectParameter& p : entry.parameters) effect.parameters[p.name] = p.default_SI;
  if (family.parameters) {
    const Eigen::Index size = term.amplitudes.size();
    for (const ParameterEstimate& p :
         family.parameters(term.shape, term.amplitudes, Eigen::MatrixXd::Identity(size, size)))
      effect.parameters[p.name] = p.value;
    return effect;
  }
  for (std::size_t k = 0; k < family.amplitudes.size(); ++k)
    effect.parameters[family.amplitudes[k].name] = term.amplitudes[static_cast<Eigen::Index>(k)];
  for (std::size_t k = 0; k < family.shapes.size(); ++k)
    effect.parameters[family.shapes[k].name] = term.shape[static_cast<Eigen::Index>(k)];
  return effect;
}

/// Whether what the twin shows of the first cause is off its tangent by more than the noise of the readings.
bool IsOffItsTangent(const Searched& searched, const std::vector<Reading>& readings,
                     const TwinComparison& comparison) {
  const Compared& c = searched.compared;
  const Term& first = searched.found().terms.front();
  const BelievedRecord asked = AskedRecord(c, readings, searched.scenario, comparison);
  const EffectSettings effect = EffectOf(searched.FamilyOf(first), first, comparison.format->effects);
  const Eigen::MatrixXd off = asked.ShownWith(effect) - asked.Shown() - first.columns * first.amplitudes;
  return Project(*searched.analysis.projector, {}, searched.analysis.noise.Whiten(c.run, off)).power[0] > 1.0;
}

/// Whether asking again with the first cause in the twin may tell more: it is named, and either what it leaves may
/// be nothing but that it was taken for linear, or its size is wrong by that.
bool MayBeCurved(const Searched& searched, const std::vector<Reading>& readings, const TwinComparison& comparison) {
  if (searched.found().terms.empty()) return false;
  const Family& first = searched.FamilyOf(searched.found().terms.front());
  if (first.kind != Kind::kNamed || (comparison.may_bend && !comparison.may_bend(first.effect))) return false;
  return searched.LeavesStructure() || (comparison.bends && IsOffItsTangent(searched, readings, comparison));
}

/// A cause as the twin carries it out, and as its family has it.
struct Tried {
  EffectSettings effect;
  Eigen::VectorXd shape, amplitudes;
};

Tried TriedOf(const Searched& searched, const Eigen::VectorXd& shape, const Eigen::VectorXd& amplitudes,
              const TwinComparison& comparison) {
  Term term = searched.found().terms.front();
  term.shape = shape;
  term.amplitudes = amplitudes;
  return {EffectOf(searched.FamilyOf(term), term, comparison.format->effects), shape, amplitudes};
}

/// The first cause at shapes that explain nearly as much of the run: where places are few, one period looks like
/// another.
std::vector<Tried> AliasesOfFirst(const Searched& searched, const TwinComparison& comparison) {
  constexpr double kNearly = 0.7;
  constexpr std::size_t kMost = 5;
  const Term& first = searched.found().terms.front();
  const Family& family = searched.FamilyOf(first);
  const LinearRun& run = searched.compared.run;
  const Projected data =
      Project(*searched.analysis.projector, {}, searched.analysis.noise.Whiten(run, Eigen::MatrixXd(run.residual)));
  const std::vector<Scanner::Fit> fits =
      searched.analysis.scanner->FitEach(first.family, 0, family.grid - 1, data, {});
  std::vector<std::size_t> maxima;
  double most = 0.0;
  for (std::size_t g = 0; g < fits.size(); ++g) {
    most = std::max(most, fits[g].power);
    const bool rises = g == 0 || fits[g].power >= fits[g - 1].power;
    if (rises && (g + 1 == fits.size() || fits[g].power > fits[g + 1].power)) maxima.push_back(g);
  }
  std::erase_if(maxima, [&](std::size_t g) { return fits[g].power < kNearly * most; });
  std::ranges::stable_sort(maxima, std::ranges::greater{}, [&](std::size_t g) { return fits[g].power; });
  std::vector<Tried> aliases = {TriedOf(searched, first.shape, first.amplitudes, comparison)};
  for (std::size_t k = 0; k < std::min(kMost, maxima.size()); ++k)
    aliases.push_back(
        TriedOf(searched, family.ShapeAt(static_cast<int>(maxima[k])), fits[maxima[k]].amplitudes, comparison));
  return aliases;
}

/// The first cause as it was found; a wave along what is read shifts its own argument, so that its size and which
/// of its aliases it is are told by the twin: those that leave least.
Tried FirstCause(const Searched& searched, const std::vector<Reading>& readings, const TwinComparison& comparison) {
  const Term& first = searched.found().terms.front();
  const Tried found = TriedOf(searched, first.shape, first.amplitudes, comparison);
  const bool is_wave = std::ranges::any_of(comparison.products, [&](const TwinComparison::Product& p) {
    return p.effect == found.effect.name && p.is_wave && !p.is_order;
  });
  if (!is_wave) return found;
  Tried best = found;
  double least = Amplitude::kInfinity;
  for (const Tried& alias : AliasesOfFirst(searched, comparison)) {
    for (const double factor : {0.35, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.25, 1.45}) {
      const Tried tried = TriedOf(searched, alias.shape, factor * alias.amplitudes, comparison);
      if (units::turn * tried.amplitudes.norm() >= tried.shape[0]) continue;  // it would run backwards
      Scenario with = searched.scenario;
      with.effects.push_back(tried.effect);
      const double power = FreeMisfit(Compare(readings, with, comparison).run).power;
      if (power >= least) continue;
      least = power;
      best = tried;
    }
  }
  return best;
}

/// The same search with slopes about the first cause at the size that was found; it is still weighed against the
/// others.
std::unique_ptr<Searched> AboutFirstCause(const Searched& before, const std::vector<Reading>& readings,
                                          const DiagnoseOptions& options, const TwinComparison& comparison) {
  const Term& first = before.found().terms.front();
  const Tried cause = FirstCause(before, readings, comparison);
  Scenario believed = before.scenario;
  believed.effects.push_back(cause.effect);
  auto after = std::make_unique<Searched>(readings, believed, options, comparison,
                                          Compare(readings, believed, comparison));
  if (after->candidates.families.size() != before.candidates.families.size() ||
      after->compared.run.Rows() != before.compared.run.Rows())
    return nullptr;
  const Family& same = after->FamilyOf(first);
  const Eigen::MatrixXd columns = same.at ? same.at(cause.shape) : same.ColumnsAt(first.grid_point);
  after->compared.run.residual += columns * cause.amplitudes;
  AnalysisOptions how = HowToAnalyse(after->compared.run, options, comparison);
  how.null = &before.analysis.null;
  after->analysis = Analyse(after->compared.run, after->candidates.families, how);
  return after;
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

std::unique_ptr<Searched> SearchIn(const std::vector<Reading>& readings, const Scenario& scenario,
                                   const DiagnoseOptions& options, const TwinComparison& comparison,
                                   Compared compared) {
  auto searched = std::make_unique<Searched>(readings, scenario, options, comparison, std::move(compared));
  searched->analysis = Analyse(searched->compared.run, searched->candidates.families,
                               HowToAnalyse(searched->compared.run, options, comparison));
  return searched;
}

/// What is believed of a record, how well it fits, and what was decided to come there.
struct Belief {
  Scenario scenario;
  TwinComparison comparison;
  Compared compared;
  Misfit misfit;
  std::vector<Cause> decided;
};

Belief BelieveIn(const std::vector<Reading>& readings, const Scenario& scenario, const ComparisonOf& comparison_of,
                 const std::vector<Cause>& decided) {
  TwinComparison comparison = comparison_of(scenario);
  Compared compared = Compare(readings, scenario, comparison);
  const Misfit misfit = FreeMisfit(compared.run);
  return {scenario, std::move(comparison), std::move(compared), misfit, decided};
}

Scenario With(Scenario scenario, const Alternative& alternative) {
  scenario.effects.push_back({alternative.effect, alternative.where, {}, ""});
  return scenario;
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

DiagnosisRun ConcludeOf(std::unique_ptr<Searched> searched, const std::vector<Reading>& readings,
                        const DiagnoseOptions& options, const TwinComparison& comparison,
                        std::vector<Cause> first) {
  if (MayBeCurved(*searched, readings, comparison)) {
    auto again = AboutFirstCause(*searched, readings, options, comparison);
    const auto terms = [](const Searched& s) { return s.found().terms.size(); };
    if (again && terms(*again) > 0 && terms(*again) <= terms(*searched)) searched = std::move(again);
  }
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
