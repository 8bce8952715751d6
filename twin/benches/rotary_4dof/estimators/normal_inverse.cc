#include "twin/benches/rotary_4dof/estimators/normal_inverse.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "twin/core/linear_algebra.h"

namespace twinbench::separate {
namespace {

constexpr double kDefective = 1e-11;  // reciprocal condition or eigenvalue of the matrix with unit diagonal
constexpr double kNoWeight = 1e-20;   // of the largest diagonal element: sin(pi)^2 instead of 0

/// What the elimination leaves of one target position: its unknowns are own - coupling * (unknowns at `rest`).
struct Eliminated {
  std::vector<int> rest;     // indices after the target's unknowns, ascending
  Eigen::MatrixXd coupling;  // 4 x rest.size()
  Matrix4 own = Matrix4::Zero();
};

/// The normal matrix in three parts, the first block-diagonal.
struct Parts {
  std::vector<Matrix4> target;  // of each position
  Eigen::MatrixXd target_rest;  // 4 n x rest
  Eigen::MatrixXd rest;         // rest x rest
};

Parts Assemble(const Design& design, const std::vector<Cell>& cells, const std::vector<StopModel>& models) {
  const int first = kTargetSeries * design.n, rest = design.Unknowns() - first;
  Parts parts{std::vector<Matrix4>(static_cast<std::size_t>(design.n), Matrix4::Zero()),
              Eigen::MatrixXd::Zero(first, rest), Eigen::MatrixXd::Zero(rest, rest)};
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const StopModel& model = models[k];
    const auto d = model.d.leftCols(model.columns);
    const Eigen::MatrixXd block = d.transpose() * cells[k].weight * d;
    parts.target[static_cast<std::size_t>(cells[k].target)] += block.topLeftCorner<4, 4>();
    for (int b = kTargetSeries; b < model.columns; ++b) {
      const int column = model.column[static_cast<std::size_t>(b)] - first;
      for (int a = 0; a < kTargetSeries; ++a) {
        parts.target_rest(model.column[static_cast<std::size_t>(a)], column) += block(a, b);
      }
      for (int a = kTargetSeries; a < model.columns; ++a) {
        parts.rest(model.column[static_cast<std::size_t>(a)] - first, column) += block(a, b);
      }
    }
  }
  return parts;
}

std::vector<bool> Supported(const Design& design, const std::vector<StopModel>& models) {
  std::vector<bool> supported(static_cast<std::size_t>(design.Unknowns()), false);
  for (const StopModel& model : models) {
    for (int c = 0; c < model.columns; ++c) supported[model.column[static_cast<std::size_t>(c)]] = true;
  }
  return supported;
}

/// Unknowns after the target's that the stops at each target position touch.
std::vector<Eliminated> FindTouched(const Design& design, const std::vector<Cell>& cells,
                                    const std::vector<StopModel>& models) {
  std::vector<Eliminated> touched(static_cast<std::size_t>(design.n));
  for (std::size_t k = 0; k < cells.size(); ++k) {
    auto& rest = touched[static_cast<std::size_t>(cells[k].target)].rest;
    for (int c = kTargetSeries; c < models[k].columns; ++c) {
      rest.push_back(models[k].column[static_cast<std::size_t>(c)] - kTargetSeries * design.n);
    }
  }
  for (Eliminated& e : touched) {
    std::sort(e.rest.begin(), e.rest.end());
    e.rest.erase(std::unique(e.rest.begin(), e.rest.end()), e.rest.end());
  }
  return touched;
}

/// Takes the target's unknowns out: parts.rest becomes its Schur complement.
std::vector<Eliminated> Eliminate(Parts& parts, std::vector<Eliminated> touched) {
  for (std::size_t i = 0; i < touched.size(); ++i) {
    Eliminated& e = touched[i];
    if (e.rest.empty()) continue;
    e.own = parts.target[i].inverse();
    const Eigen::MatrixXd across =
        parts.target_rest.middleRows<4>(4 * static_cast<Eigen::Index>(i))(Eigen::all, e.rest);
    e.coupling = e.own * across;
    parts.rest(e.rest, e.rest) -= across.transpose() * e.coupling;
  }
  return touched;
}

/// 1 / sqrt of the diagonal; 1 / sqrt of its largest element where there is next to nothing.
Eigen::VectorXd Equilibration(const Eigen::VectorXd& diagonal) {
  const double most = diagonal.maxCoeff();
  return (diagonal.array() > kNoWeight * most).select(diagonal, most).cwiseSqrt().cwiseInverse();
}

/// The known null space in scaled unknowns; unit columns, zero where nothing is left of one.
Eigen::MatrixXd ScaledNull(const Eigen::MatrixXd& null_rest, const Eigen::VectorXd& scale,
                           const std::vector<bool>& supported) {
  Eigen::MatrixXd null = scale.cwiseInverse().asDiagonal() * null_rest;
  for (Eigen::Index r = 0; r < null.rows(); ++r) {
    if (!supported[supported.size() - static_cast<std::size_t>(null.rows() - r)]) null.row(r).setZero();
  }
  for (auto column : null.colwise()) column /= std::max(column.norm(), 1e-300);
  return null;
}

/// Inverse of a symmetric matrix of unit scale, only its lower half read; `lost` gets the directions of no weight.
Eigen::MatrixXd InvertScaled(const Eigen::MatrixXd& scaled, Eigen::MatrixXd& lost) {
  lost.resize(scaled.rows(), 0);
  if (const auto inverse = InverseOfPositive(scaled, kDefective)) return *inverse;
  const auto [values, vectors] = EigenOfSymmetric(scaled);
  const Eigen::Index none = (values.array() <= kDefective * values.maxCoeff()).count();
  lost = vectors.leftCols(none);
  const auto kept = vectors.rightCols(values.size() - none);
  return kept * values.tail(values.size() - none).cwiseInverse().asDiagonal() * kept.transpose();
}

/// Rows of the target's unknowns from rows of the rest: -coupling * rest.
Eigen::MatrixXd ToTarget(const std::vector<Eliminated>& eliminated, const Eigen::MatrixXd& rest) {
  Eigen::MatrixXd target = Eigen::MatrixXd::Zero(kTargetSeries * std::ssize(eliminated), rest.cols());
  for (std::size_t i = 0; i < eliminated.size(); ++i) {
    const Eliminated& e = eliminated[i];
    if (e.rest.empty()) continue;
    target.middleRows<4>(4 * static_cast<Eigen::Index>(i)).noalias() = -e.coupling * rest(e.rest, Eigen::all);
  }
  return target;
}

/// The whole inverse from that of the rest.
Eigen::MatrixXd Complete(const std::vector<Eliminated>& eliminated, const Eigen::MatrixXd& rest) {
  const Eigen::Index first = kTargetSeries * std::ssize(eliminated);
  const Eigen::MatrixXd across = ToTarget(eliminated, rest);
  Eigen::MatrixXd inverse(first + rest.rows(), first + rest.rows());
  inverse.topLeftCorner(first, first) = ToTarget(eliminated, across.transpose());
  for (std::size_t i = 0; i < eliminated.size(); ++i) {
    const auto at = 4 * static_cast<Eigen::Index>(i);
    inverse.block<4, 4>(at, at) += eliminated[i].own;
  }
  inverse.topRightCorner(first, rest.rows()) = across;
  inverse.bottomLeftCorner(rest.rows(), first) = across.transpose();
  inverse.bottomRightCorner(rest.rows(), rest.rows()) = rest;
  return inverse;
}

}  // namespace

NormalInverse InvertNormal(const Design& design, const std::vector<Cell>& cells,
                           const std::vector<StopModel>& models, const Eigen::MatrixXd& null_space) {
  NormalInverse result;
  result.supported = Supported(design, models);
  Parts parts = Assemble(design, cells, models);
  const Eigen::VectorXd scale = Equilibration(parts.rest.diagonal());
  const std::vector<Eliminated> eliminated = Eliminate(parts, FindTouched(design, cells, models));
  Eigen::MatrixXd scaled = scale.asDiagonal() * parts.rest * scale.asDiagonal();
  const Eigen::MatrixXd null = ScaledNull(null_space.bottomRows(scaled.rows()), scale, result.supported);
  scaled.selfadjointView<Eigen::Lower>().rankUpdate(null);
  std::vector<Eigen::Index> unvisited;
  for (Eigen::Index r = 0; r < scaled.rows(); ++r) {
    if (!result.supported[static_cast<std::size_t>(kTargetSeries * design.n + r)]) unvisited.push_back(r);
  }
  for (const Eigen::Index r : unvisited) scaled(r, r) = 1.0;
  Eigen::MatrixXd lost;
  Eigen::MatrixXd rest = scale.asDiagonal() * InvertScaled(scaled, lost) * scale.asDiagonal();
  for (const Eigen::Index r : unvisited) rest(r, r) = 0.0;
  result.inverse = Complete(eliminated, rest);
  const Eigen::MatrixXd lost_rest = scale.asDiagonal() * lost;
  result.extra_null.resize(design.Unknowns(), lost.cols());
  result.extra_null.topRows(kTargetSeries * design.n) = ToTarget(eliminated, lost_rest);
  result.extra_null.bottomRows(lost_rest.rows()) = lost_rest;
  result.extra_null.colwise().normalize();
  return result;
}

}  // namespace twinbench::separate
