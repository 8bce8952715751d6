#include "twin/diagnose/engine/refine.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "twin/core/linear_algebra.h"
#include "twin/diagnose/engine/fit_within.h"

namespace twinbench::diagnose {

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
  Bounds bounds{start, start};
  for (Eigen::Index k = 0; k < start.size(); ++k) {
    const Range range = Around(family.shapes[static_cast<std::size_t>(k)], start[k]);
    bounds.lower[k] = range.lower, bounds.upper[k] = range.upper;
  }
  const auto left_by = [&](const Eigen::VectorXd& shape, Eigen::Ref<Eigen::VectorXd> left) {
    const Explained e = Explain(noise.Whiten(run, family.at(shape)), projector, others, rows);
    left = rows - e.projected * e.amplitudes;
    return e.projected.allFinite();
  };
  const Eigen::VectorXd shape = FitWithin(left_by, rows.size(), start, bounds, {.is_central = false});
  return {shape, Explain(noise.Whiten(run, family.at(shape)), projector, others, rows).power};
}

bool HasSlopes(const Family& family, const Eigen::VectorXd& shape) {
  return family.at && shape.size() > 0;
}

Eigen::MatrixXd WithShapeSlopes(const Family& family, const Eigen::VectorXd& shape, const Eigen::MatrixXd& columns,
                                const Eigen::VectorXd& amplitudes) {
  if (!HasSlopes(family, shape)) return columns;
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
