#include "twin/benches/rotary_4dof/diagnosis/search.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "twin/core/errors.h"
#include "twin/diagnose/conclusion.h"

namespace twinbench::diagnose {
namespace {

/// One way to model the bench, and the search in it.
class Trial {
 public:
  Trial(const std::vector<Reading>& readings, const DiagnoseOptions& options, const rotary::ForwardModel& model)
      : readings_(readings), options_(options), model_(model) {}

  std::unique_ptr<rotary::RotaryCase> Case(const Scenario& scenario,
                                           const std::vector<EffectSettings>& about = {}) const {
    return std::make_unique<rotary::RotaryCase>(readings_, scenario, model_, options_.excluded, about);
  }
  rotary::RotaryRun Run(const Scenario& scenario) const { return rotary::BuildRun(readings_, scenario, model_); }
  Analysis Search(const rotary::RotaryCase& rotary) const {
    return Analyse(rotary.Rotary().run, rotary.Families(), AnalysisOptionsOf(options_));
  }
  const DiagnoseOptions& Options() const { return options_; }

 private:
  const std::vector<Reading>& readings_;
  const DiagnoseOptions& options_;
  const rotary::ForwardModel& model_;
};

Scenario With(Scenario scenario, const EffectSettings& effect) {
  scenario.effects.push_back(effect);
  return scenario;
}

EffectSettings Frame() {
  EffectSettings frame;
  frame.name = "reclamp_frame";
  return frame;
}

bool IsReseated(const rotary::RotaryCase& rotary) {
  return std::ranges::any_of(rotary.Rotary().design.setups,
                             [](const separate::SetUp& s) { return s.clamping == separate::Clamping::kReseat; });
}

/// The log Bayes factor of the frame leaves the noise scale free; that it has fewer unknowns is not counted in its
/// favour.
SearchedRotary SearchFrames(const Trial& trial, const Scenario& scenario) {
  constexpr double kWorthTrying = 10.0;
  SearchedRotary stated;
  stated.rotary = trial.Case(scenario);
  if (!IsReseated(*stated.rotary) || IsExcluded(trial.Options(), "reclamp_frame")) {
    stated.analysis = trial.Search(*stated.rotary);
    return stated;
  }
  const LinearRun& run = stated.rotary->Rotary().run;
  const LinearRun turned_run = trial.Run(With(scenario, Frame())).run;
  const double evidence = 0.5 * run.Rows() * std::log(FreeMisfit(run).power / FreeMisfit(turned_run).power);
  SearchedRotary turned;
  if (evidence > kWorthTrying) {
    turned.rotary = trial.Case(With(scenario, Frame()));
    turned.analysis = trial.Search(*turned.rotary);
    turned.discrete.push_back({"reclamp_frame", "", evidence});
    if (turned.analysis.found.terms.empty()) return turned;
  }
  stated.analysis = trial.Search(*stated.rotary);
  const bool turns = evidence > kWorthTrying &&
                     evidence + turned.analysis.found.joint_evidence > stated.analysis.found.joint_evidence;
  return turns ? std::move(turned) : std::move(stated);
}

/// A change of the bench that explains the readings nearly as well as anything does, alone.
struct Suspect {
  EffectSettings effect;
  double explained = 0.0;
};

std::optional<Suspect> SuspectOf(const SearchedRotary& searched) {
  constexpr double kNearlyAsMuch = 0.5;  // bent, it may look worse than something else
  const Analysis& analysis = searched.analysis;
  const std::vector<Family>& families = analysis.scanner->Families();
  const Eigen::VectorXd explained = analysis.found.alone.explained.col(0);
  int best = -1;
  for (int k = 0; k < std::ssize(families); ++k) {
    const Family& f = families[static_cast<std::size_t>(k)];
    const bool bends = f.kind == Kind::kNamed && f.amplitudes.size() == 1 && rotary::IsOfBench(f.effect);
    if (bends && (best < 0 || explained[k] > explained[best])) best = k;
  }
  if (best < 0 || explained[best] < kNearlyAsMuch * explained.maxCoeff()) return {};
  const Family& family = families[static_cast<std::size_t>(best)];
  const LinearRun& run = searched.rotary->Rotary().run;
  const Deflation alone(*analysis.projector, analysis.noise.Whiten(run, family.ColumnsAt(0)));
  const Eigen::MatrixXd white = analysis.noise.Whiten(run, Eigen::MatrixXd(run.residual));
  Suspect suspect;
  suspect.effect.name = family.effect;
  suspect.effect.where = family.where;
  const Amplitude& a = family.amplitudes[0];
  const double size = alone.Amplitudes(analysis.projector->Apply(white))(0, 0);
  if (size < a.lower || size > a.upper) return {};  // no bench can be built that way
  suspect.effect.parameters[a.name] = size;
  suspect.explained = explained[best];
  return suspect;
}

/// Log evidence of a model and all that was found in it, up to what all models share.
double LogEvidence(const SearchedRotary& searched) {
  const double trust = PseudoDegrees(searched.rotary->Rotary().run);
  return searched.analysis.found.joint_evidence - 0.5 * (trust + searched.analysis.projector->DegreesOfFreedom()) *
                                                      std::log(trust + searched.analysis.power);
}

/// What a bench leaves unexplained; nothing if it would show no spots where there are readings.
std::optional<double> PowerOn(const Trial& trial, const Scenario& scenario) {
  try {
    return FreeMisfit(trial.Run(scenario).run).power;
  } catch (const InputError&) {
    return {};
  }
}

/// Searches again about the size of a large change of the bench, where its tangent no longer tells what it does.
/// About it means: linearised with the change in the model, and its tangent there taken out again.
void SearchAboutSuspect(const Trial& trial, const Scenario& scenario, SearchedRotary& searched) {
  constexpr double kStraight = 4.0;  // of the whitened power: as far as a tangent may be off
  if (searched.analysis.found.terms.empty()) return;
  const std::optional<Suspect> suspect = SuspectOf(searched);
  if (!suspect) return;
  const Scenario framed = searched.discrete.empty() ? scenario : With(scenario, Frame());
  const std::optional<double> with_it = PowerOn(trial, With(framed, suspect->effect));
  const double by_tangent = FreeMisfit(searched.rotary->Rotary().run).power - suspect->explained;
  if (!with_it || std::abs(*with_it - by_tangent) < kStraight) return;
  SearchedRotary about;
  about.rotary = trial.Case(framed, {suspect->effect});
  about.discrete = searched.discrete;
  about.analysis = trial.Search(*about.rotary);
  if (LogEvidence(about) > LogEvidence(searched)) searched = std::move(about);
}

}  // namespace

SearchedRotary SearchRotary(const std::vector<Reading>& readings, const Scenario& scenario,
                            const DiagnoseOptions& options, const rotary::ForwardModel& model) {
  const Trial trial(readings, options, model);
  SearchedRotary searched = SearchFrames(trial, scenario);
  SearchAboutSuspect(trial, scenario, searched);
  return searched;
}

}  // namespace twinbench::diagnose
