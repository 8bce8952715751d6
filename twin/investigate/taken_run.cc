#include "twin/investigate/taken_run.h"

#include <algorithm>
#include <utility>

#include "twin/core/errors.h"
#include "twin/diagnose/in_frame.h"
#include "twin/diagnose/mean_of_runs.h"

namespace twinbench::investigate {
namespace {

/// By the run's noise as it stands.
void Whiten(TakenRun& run) {
  run.projector = std::make_shared<diagnose::Projector>(run.noise.Whiten(run.linear, run.linear.nuisance.jacobian),
                                                        run.linear.nuisance);
  const Eigen::MatrixXd residual = run.linear.residual;
  run.left = run.noise.Whiten(run.linear, residual);
}

}  // namespace

TakenRun TakenOf(const plan::NextRun& asked, const Scenario& scenario, std::vector<Reading> readings,
                 const Means& means, int number) {
  TakenRun run;
  run.number = number;
  run.asked = asked;
  run.scenario = scenario;
  run.readings = std::move(readings);
  constexpr double kShortest_min = 0.01;  // even of readings without times
  if (!run.readings.empty()) run.minutes = std::max(kShortest_min, ToSeconds(run.readings.back().time) / 60.0);
  run.linear = means.against(run.readings, scenario);
  run.noise.sigma = run.linear.sigma;
  Whiten(run);
  return run;
}

void StrikeOutliers(const diagnose::NoiseModel& found, TakenRun& run) {
  if (found.sigma.size() != run.noise.sigma.size()) return;
  constexpr double kFar = 100.0;  // heavy tails and channels noisier than stated are less so
  const auto is_struck = found.sigma.array() > kFar * run.noise.sigma.array();
  if (!is_struck.any()) return;
  run.noise.sigma = is_struck.select(found.sigma, run.noise.sigma).eval();
  Whiten(run);
}

namespace {

/// The run's own twin set to that scenario, white. Unknowns that have to move for it do so once, by the run's slopes.
Eigen::MatrixXd LeftByItsTwin(const Scenario& with, const TakenRun& run) {
  const diagnose::LeftWhere left_where = run.linear.left_by_another(with);
  if (!left_where) return {};
  const auto white = [&](const Eigen::VectorXd& unknowns) -> Eigen::MatrixXd {
    const Eigen::MatrixXd left = left_where(unknowns);
    return run.noise.Whiten(run.linear, left);
  };
  const Eigen::MatrixXd unmoved = white(Eigen::VectorXd::Zero(run.linear.nuisance.jacobian.cols()));
  return unmoved.allFinite() ? white(run.projector->Solve(unmoved)) : unmoved;
}

/// A run made anew against that scenario, white in the frame of this one.
Eigen::MatrixXd LeftByAnotherRun(const Scenario& with, const TakenRun& run, const Means& means) {
  const diagnose::LinearRun other = means.against(run.readings, with);
  if (other.Rows() != run.linear.Rows()) return {};
  const Eigen::MatrixXd left = diagnose::LeftInFrame(other, run.linear, run.noise);
  return run.noise.Whiten(run.linear, left);
}

}  // namespace

Eigen::VectorXd LeftBy(const Hypothesis& hypothesis, const TakenRun& run, const Means& means) {
  if (hypothesis.IsNothing()) return run.left;
  try {
    const Scenario with = With(run.scenario, hypothesis, run.number);
    Eigen::MatrixXd left;
    if (run.linear.left_by_another) left = LeftByItsTwin(with, run);
    if (left.size() == 0) left = LeftByAnotherRun(with, run, means);
    const bool is_told = left.size() > 0 && left.allFinite();  // it may show no light where there was some
    return is_told ? Eigen::VectorXd(left) : run.left;
  } catch (const InputError&) {
    return run.left;
  }
}

double WorthOf(const TakenRun& run, const TakenRun& first) {
  if (run.asked.sets == first.asked.sets) return 1.0;
  if (run.asked.is_of_another_kind) return 0.0;
  if (!run.asked.is_denser && !diagnose::AreOfOnePlan(run.readings, first.readings)) return 0.0;
  return run.linear.sigma.array().square().inverse().sum() / first.linear.sigma.array().square().inverse().sum();
}

Eigen::MatrixXd Product(const TakenRun& run, const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a.transpose() * run.projector->Apply(b);
}

}  // namespace twinbench::investigate
