#include "twin/diagnose/engine/refine.h"

#include <ceres/ceres.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "twin/core/linear_algebra.h"

namespace twinbench::diagnose {
namespace {

/// What is left of the data when a family with this shape has explained its share.
struct ShapeResidual {
  const Family& family;
  const LinearRun& run;
  const NoiseModel& noise;
  const Projector& projector;
  const Deflation& others;
  const Eigen::VectorXd& data;

  bool operator()(double const* const* parameters, double* residuals) const {
    const Eigen::VectorXd shape = Eigen::Map<const Eigen::VectorXd>(parameters[0], std::ssize(family.shapes));
    const Explained e = Explain(noise.Whiten(run, family.at(shape)), projector, others, data);
    Eigen::Map<Eigen::VectorXd>(residuals, data.size()) = data - e.projected * e.amplitudes;
    return e.projected.allFinite();
  }
};

ceres::Solver::Options SolverOptions() {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 12;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;
  options.max_num_line_search_step_size_iterations = 0;  // at a bound a shorter step does as well, and sooner
  return options;
}

}  // namespace

Range Around(const Shape& shape, double value) {
  double below = shape.lower, above = shape.upper;
  for (const double v : shape.value) {
    if (v < value) below = std::max(below, v);
    if (v > value) above = std::min(above, v);
  }
  return {std::min(below, value), std::max(above, value)};
}

Explained Explain(const Eigen::MatrixXd& white, const Projector& projector, const Deflation& others,
                  const Eigen::VectorXd& data) {
  Explained e;
  e.projected = others.Apply(projector.Apply(white));
  const Eigen::VectorXd products = white.transpose() * data;
  e.amplitudes = SolveShortest(white.transpose() * e.projected, products);
  e.power = products.dot(e.amplitudes);
  return e;
}

Refined RefineShape(const Family& family, int grid_point, const LinearRun& run, const NoiseModel& noise,
                    const Projector& projector, const Deflation& others, const Projected& data) {
  const Eigen::VectorXd start = family.ShapeAt(grid_point), rows = data.rows.col(0);
  Eigen::VectorXd shape = start;
  using Cost = ceres::DynamicNumericDiffCostFunction<ShapeResidual, ceres::CENTRAL>;
  auto* cost = new Cost(new ShapeResidual{family, run, noise, projector, others, rows});  // Ceres takes ownership
  cost->AddParameterBlock(static_cast<int>(shape.size()));
  cost->SetNumResiduals(run.Rows());
  ceres::Problem problem;
  problem.AddResidualBlock(cost, nullptr, shape.data());
  for (std::size_t k = 0; k < family.shapes.size(); ++k) {
    const Range range = Around(family.shapes[k], shape[static_cast<Eigen::Index>(k)]);
    problem.SetParameterLowerBound(shape.data(), static_cast<int>(k), range.lower);
    problem.SetParameterUpperBound(shape.data(), static_cast<int>(k), range.upper);
  }
  ceres::Solver::Summary summary;
  ceres::Solve(SolverOptions(), &problem, &summary);
  if (!summary.IsSolutionUsable()) shape = start;
  return {shape, Explain(noise.Whiten(run, family.at(shape)), projector, others, rows).power};
}

Eigen::MatrixXd WithShapeSlopes(const Family& family, const Eigen::VectorXd& shape, const Eigen::MatrixXd& columns,
                                const Eigen::VectorXd& amplitudes) {
  if (!family.at || shape.size() == 0) return columns;
  Eigen::MatrixXd all(columns.rows(), columns.cols() + shape.size());
  all.leftCols(columns.cols()) = columns;
  for (Eigen::Index k = 0; k < shape.size(); ++k) {
    const Shape& s = family.shapes[static_cast<std::size_t>(k)];
    const double step = 1e-4 * std::max(std::abs(shape[k]), 1e-3 * (s.upper - s.lower));
    const Eigen::VectorXd moved = shape + step * Eigen::VectorXd::Unit(shape.size(), k);
    all.col(columns.cols() + k) = (family.at(moved) - columns) * amplitudes / step;
  }
  return all;
}

}  // namespace twinbench::diagnose
