#include "twin/diagnose/by_twin.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "twin/diagnose/compared.h"
#include "twin/diagnose/conclusion.h"
#include "twin/diagnose/engine/analysis.h"
#include "twin/diagnose/to_readings.h"
#include "twin/diagnose/twin_candidates.h"

namespace twinbench::diagnose {
namespace {

/// "zero of a set-up up to 0.3 um": the largest constant of each free point; of many points those that show most.
std::string BiasOf(const LinearRun& run, const FreeConstants& free, const Eigen::VectorXd& fitted) {
  constexpr std::size_t kMostTold = 4;
  const Eigen::VectorXd constants = free.fitted * fitted;
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
           const TwinComparison& comparison)
      : scenario(believed),
        compared(Compare(readings, scenario, comparison)),
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
  if (searched.found().terms.empty() || searched.FamilyOf(searched.found().terms.front()).kind != Kind::kNamed)
    return false;
  return searched.LeavesStructure() || (comparison.bends && IsOffItsTangent(searched, readings, comparison));
}

/// The same search with slopes about the first cause at the size that was found; it is still weighed against the
/// others.
std::unique_ptr<Searched> AboutFirstCause(const Searched& before, const std::vector<Reading>& readings,
                                          const DiagnoseOptions& options, const TwinComparison& comparison) {
  const Term& first = before.found().terms.front();
  Scenario believed = before.scenario;
  believed.effects.push_back(EffectOf(before.FamilyOf(first), first, comparison.format->effects));
  auto after = std::make_unique<Searched>(readings, believed, options, comparison);
  if (after->candidates.families.size() != before.candidates.families.size() ||
      after->compared.run.Rows() != before.compared.run.Rows())
    return nullptr;
  const Family& same = after->FamilyOf(first);
  const Eigen::MatrixXd columns = same.at ? same.at(first.shape) : same.ColumnsAt(first.grid_point);
  after->compared.run.residual += columns * first.amplitudes;
  AnalysisOptions how = HowToAnalyse(after->compared.run, options, comparison);
  how.null = &before.analysis.null;
  after->analysis = Analyse(after->compared.run, after->candidates.families, how);
  return after;
}

}  // namespace

LinearRun CompareWithTwin(const std::vector<Reading>& readings, const Scenario& scenario,
                          const TwinComparison& comparison) {
  return Compare(readings, scenario, comparison).run;
}

DiagnosisRun DiagnoseByTwin(const std::vector<Reading>& readings, const Scenario& scenario,
                            const DiagnoseOptions& options, const TwinComparison& comparison) {
  auto searched = std::make_unique<Searched>(readings, scenario, options, comparison);
  searched->analysis = Analyse(searched->compared.run, searched->candidates.families,
                               HowToAnalyse(searched->compared.run, options, comparison));
  if (MayBeCurved(*searched, readings, comparison)) {
    auto again = AboutFirstCause(*searched, readings, options, comparison);
    const auto terms = [](const Searched& s) { return s.found().terms.size(); };
    if (again && terms(*again) > 0 && terms(*again) <= terms(*searched)) searched = std::move(again);
  }
  const Compared& c = searched->compared;
  DiagnosisRun result =
      Conclude(c.run, searched->analysis, OutliersLeftOut(c, comparison, options.excluded),
               {[&](const std::string&, const Eigen::VectorXd& x) { return BiasOf(c.run, c.free, x); },
                comparison.next_measurement ? comparison.next_measurement : NextOf});
  std::ranges::copy(searched->candidates.invisible, std::back_inserter(result.diagnosis.invisible));
  result.diagnosis.left_out = static_cast<int>(readings.size() - c.used.size() - c.outliers.readings.size());
  if (comparison.sampled) ToReadings(c, comparison, result);
  return result;
}

}  // namespace twinbench::diagnose
