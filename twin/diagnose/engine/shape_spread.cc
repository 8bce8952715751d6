#include "twin/diagnose/engine/shape_spread.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace twinbench::diagnose {
namespace {

constexpr int kMostColumns = 512;  // of signatures to look at: a few hundredths of a second

/// A signature's best amplitudes in projected data, and what it explains of them.
struct Fit {
  Eigen::VectorXd amplitudes;
  double explained = 0.0;
};

Fit FitOf(const Eigen::MatrixXd& S, const Projector& projector, const Remainder& others, const Projected& data) {
  const Eigen::MatrixXd gram = S.transpose() * others.Apply(projector.Apply(S));
  const Eigen::VectorXd products = S.transpose() * data.rows.col(0);
  Fit fit{gram.completeOrthogonalDecomposition().solve(products), 0.0};
  fit.explained = products.dot(fit.amplitudes);
  return fit;
}

/// Mean distance of a value to its neighbours on the grid: all that is known between them.
double SpacingAt(const Shape& shape, double value) {
  double below = shape.lower, above = shape.upper;
  for (const double v : shape.value) {
    if (v < value) below = std::max(below, v);
    if (v > value) above = std::min(above, v);
  }
  return 0.5 * (above - below);
}

}  // namespace

Spread SpreadOverGrid(const Family& family, const Pick& pick, const LinearRun& run, const NoiseModel& noise,
                      const Projector& projector, const Remainder& others, const Projected& data, double variance) {
  Spread spread{Eigen::VectorXd::Zero(pick.columns.cols()), Eigen::VectorXd::Zero(pick.shape.size())};
  if (pick.shape.size() == 0) return spread;
  const auto fit = [&](const Eigen::MatrixXd& columns) {
    return FitOf(noise.Whiten(run, columns), projector, others, data);
  };
  const Fit best = fit(pick.columns);
  double sum = 1.0;  // the fitted shape itself
  const int reach = std::max(1, kMostColumns / 2 / static_cast<int>(pick.columns.cols()));
  const int first = std::max(0, pick.grid_point - reach), last = std::min(family.grid - 1, pick.grid_point + reach);
  for (int g = first; g <= last; ++g) {
    const Fit other = fit(family.ColumnsAt(g));
    const double weight = std::exp(std::min(0.0, 0.5 * (other.explained - best.explained) / variance));
    spread.amplitudes += weight * (other.amplitudes - best.amplitudes).cwiseAbs2();
    spread.shape += weight * (family.ShapeAt(g) - pick.shape).cwiseAbs2();
    sum += weight;
  }
  spread.amplitudes = (spread.amplitudes / sum).cwiseSqrt();
  spread.shape /= sum;
  if (!family.at) {
    for (Eigen::Index k = 0; k < spread.shape.size(); ++k)
      spread.shape[k] += std::pow(SpacingAt(family.shapes[static_cast<std::size_t>(k)], pick.shape[k]), 2) / 12.0;
  }
  spread.shape = spread.shape.cwiseSqrt();
  return spread;
}

}  // namespace twinbench::diagnose
