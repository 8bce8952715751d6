#include "twin/diagnose/engine/fit_within.h"

#include <ceres/ceres.h>
#include <glog/logging.h>

namespace twinbench::diagnose {
namespace {

struct AsCost {
  const Residuals& residuals;
  Eigen::Index rows, parameters;

  bool operator()(double const* const* x, double* left) const {
    return residuals(Eigen::Map<const Eigen::VectorXd>(x[0], parameters), Eigen::Map<Eigen::VectorXd>(left, rows));
  }
};

/// For a problem, which takes ownership.
template <ceres::NumericDiffMethodType method>
ceres::CostFunction* Differenced(const AsCost& cost, const FitSteps& steps) {
  ceres::NumericDiffOptions differences;
  differences.relative_step_size = steps.relative_size;
  auto* differenced = new ceres::DynamicNumericDiffCostFunction<AsCost, method>(new AsCost(cost), ceres::TAKE_OWNERSHIP, differences);
  differenced->AddParameterBlock(static_cast<int>(cost.parameters));
  differenced->SetNumResiduals(static_cast<int>(cost.rows));
  return differenced;
}

ceres::Solver::Options SolverOptions(int most) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = most;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;
  options.max_num_line_search_step_size_iterations = 0;  // at a bound a shorter step does as well, and sooner
  return options;
}

/// What goes wrong within the solver is told by its summary; its log is nobody's business but its makers'.
void SilenceSolver() {
  FLAGS_minloglevel = google::GLOG_FATAL;
}

}  // namespace

Eigen::VectorXd FitWithin(const Residuals& residuals, Eigen::Index rows, const Eigen::VectorXd& start, const Bounds& bounds,
                          const FitSteps& steps) {
  const AsCost cost{residuals, rows, start.size()};
  Eigen::VectorXd x = start;
  ceres::Problem problem;
  problem.AddResidualBlock(steps.is_central ? Differenced<ceres::CENTRAL>(cost, steps) : Differenced<ceres::FORWARD>(cost, steps), nullptr,
                           x.data());
  for (int k = 0; k < static_cast<int>(start.size()); ++k) {
    problem.SetParameterLowerBound(x.data(), k, bounds.lower[k]);
    problem.SetParameterUpperBound(x.data(), k, bounds.upper[k]);
  }
  [[maybe_unused]] static const bool is_silent = (SilenceSolver(), true);
  ceres::Solver::Summary summary;
  ceres::Solve(SolverOptions(steps.most), &problem, &summary);
  return summary.IsSolutionUsable() ? x : start;
}

}  // namespace twinbench::diagnose
