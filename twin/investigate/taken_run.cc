#include "twin/investigate/taken_run.h"

#include <algorithm>
#include <utility>

#include "twin/core/errors.h"
#include "twin/diagnose/in_frame.h"

namespace twinbench::investigate {

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
  run.projector = std::make_shared<diagnose::Projector>(run.noise.Whiten(run.linear, run.linear.nuisance.jacobian),
                                                        run.linear.nuisance);
  const Eigen::MatrixXd residual = run.linear.residual;
  run.left = run.noise.Whiten(run.linear, residual);
  return run;
}

Eigen::VectorXd LeftBy(const Hypothesis& hypothesis, const TakenRun& run, const Means& means) {
  if (hypothesis.causes.empty() && hypothesis.besides.empty()) return run.left;
  try {
    const diagnose::LinearRun with = means.against(run.readings, With(run.scenario, hypothesis, run.number));
    if (with.Rows() != run.linear.Rows()) return run.left;
    const Eigen::MatrixXd left = diagnose::LeftInFrame(with, run.linear, run.noise);
    return run.noise.Whiten(run.linear, left);
  } catch (const InputError&) {
    return run.left;
  }
}

Eigen::MatrixXd Product(const TakenRun& run, const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a.transpose() * run.projector->Apply(b);
}

}  // namespace twinbench::investigate
