#include "twin/diagnose/about_first_cause.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "twin/core/units.h"

namespace twinbench::diagnose {
namespace {

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

/// The twin can carry it out.
bool CanBeTried(const EffectSettings& effect, const std::vector<EffectEntry>& catalogue) {
  const EffectEntry& entry = *std::ranges::find(catalogue, effect.name, &EffectEntry::name);
  return std::ranges::all_of(entry.parameters, [&](const EffectParameter& p) {
    const double value = effect.parameters.at(p.name);
    return value >= p.lower_SI && value <= p.upper_SI;
  });
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
      if (!CanBeTried(tried.effect, comparison.format->effects)) continue;
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

/// The causes without a shape beside the first: a product of two of them is as large as the square of one.
std::vector<const Term*> BesideTheFirst(const Searched& searched, const TwinComparison& comparison) {
  std::vector<const Term*> beside;
  if (!comparison.together) return beside;
  for (std::size_t k = 1; k < searched.found().terms.size(); ++k) {
    const Term& term = searched.found().terms[k];
    const Family& family = searched.FamilyOf(term);
    if (family.kind != Kind::kNamed || family.at || family.grid != 1 || (comparison.may_bend && !comparison.may_bend(family.effect))) continue;
    if (CanBeTried(EffectOf(family, term, comparison.format->effects), comparison.format->effects)) beside.push_back(&term);
  }
  return beside;
}

/// Whether asking again with the first cause in the twin may tell more.
bool MayBeCurved(const Searched& searched, const std::vector<Reading>& readings, const TwinComparison& comparison) {
  if (searched.found().terms.empty()) return false;
  const Family& first = searched.FamilyOf(searched.found().terms.front());
  if (first.kind != Kind::kNamed || (comparison.may_bend && !comparison.may_bend(first.effect))) return false;
  if (!CanBeTried(EffectOf(first, searched.found().terms.front(), comparison.format->effects), comparison.format->effects)) return false;
  return searched.LeavesStructure() || (comparison.bends && IsOffItsTangent(searched, readings, comparison));
}

/// Null if other things can be searched for there.
std::unique_ptr<Searched> AboutFirstCause(const Searched& before, const std::vector<Reading>& readings,
                                          const DiagnoseOptions& options, const TwinComparison& comparison) {
  const std::vector<Term>& terms = before.found().terms;
  const Tried cause = FirstCause(before, readings, comparison);
  Scenario believed = before.scenario;
  believed.effects.push_back(cause.effect);
  const std::vector<const Term*> beside = BesideTheFirst(before, comparison);
  for (const Term* term : beside) believed.effects.push_back(EffectOf(before.FamilyOf(*term), *term, comparison.format->effects));
  auto after =
      std::make_unique<Searched>(readings, believed, options, comparison, Compare(readings, believed, comparison));
  if (after->candidates.families.size() != before.candidates.families.size() ||
      after->compared.run.Rows() != before.compared.run.Rows())
    return nullptr;
  const Family& same = after->FamilyOf(terms.front());
  const Eigen::MatrixXd columns = same.at ? same.at(cause.shape) : same.ColumnsAt(terms.front().grid_point);
  after->compared.run.residual += columns * cause.amplitudes;
  for (const Term* term : beside) after->compared.run.residual += after->FamilyOf(*term).ColumnsAt(0) * term->amplitudes;
  AnalysisOptions how = HowToAnalyse(after->compared.run, options, comparison);
  how.null = &before.analysis.null;
  after->analysis = Analyse(after->compared.run, after->candidates.families, how);
  return after;
}

/// The cause of the catalogue that alone explains nearly as much as the structure that leads.
std::optional<Term> NamedBehindStructure(const Searched& searched, const TwinComparison& comparison) {
  constexpr double kNearly = 0.8;
  if (searched.found().terms.empty() || searched.FamilyOf(searched.found().terms.front()).kind == Kind::kNamed) return {};
  const Evidence& alone = searched.found().alone;
  const auto explained = [&](int family) { return alone.explained(family, 0); };
  const LinearRun& run = searched.compared.run;
  const Projected data = Project(*searched.analysis.projector, {}, searched.analysis.noise.Whiten(run, Eigen::MatrixXd(run.residual)));
  std::optional<Term> best;
  double most = kNearly * explained(searched.found().terms.front().family);
  for (int f = 0; f < static_cast<int>(std::ssize(searched.candidates.families)); ++f) {
    const Family& family = searched.candidates.families[static_cast<std::size_t>(f)];
    if (family.kind != Kind::kNamed || explained(f) < most || (comparison.may_bend && !comparison.may_bend(family.effect))) continue;
    const int g = alone.grid_point(f, 0);
    Term term;
    term.family = f;
    term.grid_point = g;
    term.shape = family.ShapeAt(g);
    term.columns = family.ColumnsAt(g);
    term.amplitudes = searched.analysis.scanner->FitEach(f, g, g, data, {}).front().amplitudes;
    if (!CanBeTried(EffectOf(family, term, comparison.format->effects), comparison.format->effects)) continue;
    most = explained(f);
    best = term;
  }
  return best;
}

}  // namespace

std::unique_ptr<Searched> SearchedAboutFirst(Searched& before, const std::vector<Reading>& readings, const DiagnoseOptions& options,
                                             const TwinComparison& comparison) {
  std::vector<Term>& terms = before.analysis.found.terms;
  if (MayBeCurved(before, readings, comparison)) {
    auto again = AboutFirstCause(before, readings, options, comparison);
    return again && !again->found().terms.empty() && again->found().terms.size() <= terms.size() ? std::move(again) : nullptr;
  }
  const std::optional<Term> named = NamedBehindStructure(before, comparison);
  if (!named) return nullptr;
  const std::vector<Term> structure = std::exchange(terms, {*named});
  auto again = AboutFirstCause(before, readings, options, comparison);
  terms = structure;
  if (!again || again->found().terms.size() > structure.size()) return nullptr;
  const Family& behind = before.FamilyOf(*named);
  const bool stays = std::ranges::any_of(again->found().terms, [&](const Term& term) {
    const Family& family = again->FamilyOf(term);
    return family.effect == behind.effect && family.where == behind.where;
  });
  return stays ? std::move(again) : nullptr;
}

}  // namespace twinbench::diagnose
