#include "tests/plan/plan_claims.h"

#include "tools/twinbench/passing_run.h"
#include "tools/twinbench/planned_run.h"
#include "twin/benches/names.h"
#include "twin/benches/registry.h"
#include "twin/benches/rotary_4dof/diagnose.h"
#include "twin/core/errors.h"
#include "twin/diagnose/cause_groups.h"
#include "twin/diagnose/engine/noise_model.h"
#include "twin/diagnose/tuning.h"
#include "twin/diagnose/words.h"

namespace twinbench::plan {
namespace {

using diagnose::Isolability;

/// The cause's number; that of none is the count.
std::size_t IndexOf(const Isolability& isolability, const std::string& effect, const std::string& where) {
  const auto found = std::ranges::find_if(isolability.causes, [&](const diagnose::ShownCause& cause) {
    return cause.effect == effect && cause.where == where;
  });
  return static_cast<std::size_t>(found - isolability.causes.begin());
}

bool IsForetold(const Isolability& foretold, const EffectSettings& truth, const diagnose::Cause& blamed, double rho) {
  const std::size_t a = IndexOf(foretold, truth.name, truth.where), b = IndexOf(foretold, blamed.effect, blamed.where);
  if (a == foretold.causes.size() || b == foretold.causes.size()) return false;
  return MayBeBlamed(foretold, a, b, rho / diagnose::tuning::kBaarda);
}

/// Of the group that has the truth in it; without one, of the first.
const diagnose::CauseGroup& GroupOf(const std::vector<diagnose::CauseGroup>& groups,
                                    const std::vector<diagnose::Cause>& causes, const EffectSettings& truth) {
  for (const diagnose::CauseGroup& group : groups) {
    if (std::ranges::any_of(
            group, [&](std::size_t k) { return causes[k].effect == truth.name && causes[k].where == truth.where; }))
      return group;
  }
  return groups.front();
}

/// A linear run with what takes its free unknowns out.
struct Against {
  Against(const Scenario& s, const std::vector<Reading>& readings)
      : linear(BenchOf(s).linear_run(readings, s, Estimator::kRigorous)),
        noise{linear.sigma, {}},
        projector(noise.Whiten(linear, linear.nuisance.jacobian), linear.nuisance) {}

  Eigen::VectorXd Left(const Scenario& s, const std::vector<Reading>& readings) const {
    const diagnose::LinearRun other = BenchOf(s).linear_run(readings, s, Estimator::kRigorous);
    Require(other.Rows() == linear.Rows(), "every run shows the same readings");
    return noise.Whiten(linear, Eigen::MatrixXd(other.residual));
  }

  diagnose::LinearRun linear;
  diagnose::NoiseModel noise;
  diagnose::Projector projector;
};

/// Constants of the bench that the diagnosis takes for uncertain, each drawn with the deviation that it believes, as
/// causes in the twin: what a plan says of sizes allows for them.
std::vector<EffectSettings> DrawnConstants(const Scenario& scenario, std::uint64_t run) {
  std::vector<EffectSettings> effects;
  if (scenario.bench != kRotaryBench) return effects;
  Stream stream(run, "plan.constants");
  for (const auto& constant : benches::rotary::CalibratedConstants()) {
    effects.push_back({constant.effect, constant.where, {{constant.parameter, constant.sd * stream.Normal()}}, ""});
  }
  return effects;
}

}  // namespace

bool MayBeBlamed(const Isolability& foretold, std::size_t present, std::size_t blamed, double times) {
  return std::ranges::any_of(foretold.confusable, [&](const diagnose::Confusable& pair) {
    return pair.present == present && pair.blamed == blamed && times < pair.surely_told_from;
  });
}

Isolability ForetoldOf(hidden::Design design) {
  const Scenario believed = hidden::Believed(design);
  tools::Patience without_end;
  return *tools::SeenUnderChance(believed, hidden::TakeReadings(believed), without_end).isolability;
}

TieCase DiagnoseHidden(const hidden::Placement& at, std::uint64_t seed, double rho, const hidden::SignatureScale& scale,
                       const Isolability& foretold) {
  const Scenario hidden = hidden::HiddenBench(at.design, seed, {{at.effect, at.where, rho}}, scale);
  const Scenario believed = hidden::Believed(at.design);
  diagnose::DiagnoseOptions options;
  options.null_runs = 100;  // what counts is which causes share an answer
  const diagnose::Diagnosis found =
      BenchOf(believed).diagnose(hidden::TakeReadings(hidden), believed, options).diagnosis;
  const EffectSettings& truth = hidden.effects.front();
  TieCase result{diagnose::Place(truth.name, truth.where), {}, diagnose::VerdictName(found.verdict)};
  const bool has_answer = found.verdict == diagnose::Verdict::kNamed || found.verdict == diagnose::Verdict::kTie;
  const std::vector<diagnose::CauseGroup> groups = diagnose::GroupsOf(found.causes);
  if (!has_answer || groups.empty()) return result;
  for (const std::size_t k : GroupOf(groups, found.causes, truth)) {
    const diagnose::Cause& cause = found.causes[k];
    if (cause.effect == truth.name && cause.where == truth.where) continue;
    result.pairs.push_back(
        {result.truth, diagnose::Place(cause.effect, cause.where), IsForetold(foretold, truth, cause, rho)});
  }
  return result;
}

std::vector<SizeCheck> CheckSizes(const Scenario& scenario, int runs, const std::vector<std::string>& effects) {
  const std::vector<Reading> own = tools::ReadingsOfTwin(scenario);
  const Isolability isolability = *tools::SeenBy(scenario, own).isolability;
  const Against against(scenario, own);
  const Eigen::VectorXd left = against.Left(scenario, own);
  std::vector<Eigen::VectorXd> projected;  // W s
  std::vector<SizeCheck> checks;
  Eigen::VectorXd length2(std::ssize(isolability.causes));
  for (const diagnose::ShownCause& cause : isolability.causes) {
    if (cause.at_smallest.empty()) continue;
    if (!effects.empty() && std::ranges::count(effects, cause.effect) == 0) continue;
    Scenario with = scenario;
    with.effects.push_back(diagnose::AsEffect(cause, scenario.bench));
    try {
      const Eigen::VectorXd s = against.Left(scenario, tools::ReadingsOfTwin(with)) - left;
      const Eigen::MatrixXd Ws = against.projector.Apply(s);
      length2[std::ssize(projected)] = s.dot(Ws.col(0));
      projected.push_back(Ws.col(0));
      checks.push_back({diagnose::Place(cause.effect, cause.where)});
    } catch (const std::exception&) {  // shows other readings: no signature to be held against
    }
  }
  Eigen::VectorXd sum2 = Eigen::VectorXd::Zero(std::ssize(projected)), sum = sum2;
  for (int run = 0; run < runs; ++run) {
    Scenario other = scenario;
    other.seed = scenario.seed + 1000 + static_cast<std::uint64_t>(run);
    for (EffectSettings& effect : DrawnConstants(scenario, other.seed)) other.effects.push_back(std::move(effect));
    const Eigen::VectorXd y = against.Left(scenario, tools::ReadingsOfTwin(other));
    for (std::size_t k = 0; k < projected.size(); ++k) {
      const double t = projected[k].dot(y);
      sum[static_cast<Eigen::Index>(k)] += t;
      sum2[static_cast<Eigen::Index>(k)] += t * t;
    }
  }
  for (std::size_t k = 0; k < checks.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    const double variance = sum2[i] / runs - (sum[i] / runs) * (sum[i] / runs);
    checks[k].ratio = diagnose::tuning::kBaarda * std::sqrt(variance) / length2[i];
  }
  return checks;
}

}  // namespace twinbench::plan
