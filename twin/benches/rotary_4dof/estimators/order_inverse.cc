#include "twin/benches/rotary_4dof/estimators/order_inverse.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <utility>

#include "twin/core/linear_algebra.h"
#include "twin/separate/fourier.h"

namespace twinbench::separate {
namespace {

constexpr double kDefectiveOrder = 1e-11;  // as in InvertNormal
constexpr double kNoOrderWeight = 1e-20;   // likewise
constexpr double kSameWeight = 1e-12;      // relative: rounding of sums over passes
constexpr double kLeastLeft = 1e-7;        // of a direction's weight, after what is missing is taken out

/// The heaviest stop of each set-up.
std::vector<Matrix4> FullWeights(const Design& design, const std::vector<Cell>& cells) {
  std::vector<Matrix4> weights(design.setups.size(), Matrix4::Zero());
  for (const Cell& cell : cells) {
    Matrix4& full = weights[static_cast<std::size_t>(cell.setup)];
    if (cell.weight.trace() > full.trace()) full = cell.weight;
  }
  return weights;
}

/// R with R R^T = full - weight, without what rounding makes; nothing if it is negative in some direction.
std::optional<Eigen::MatrixXd> RootOfLacking(const Matrix4& full, const Matrix4& weight) {
  const Vector4 unit = full.diagonal().cwiseSqrt(), scale = unit.cwiseInverse();
  const Eigen::MatrixXd lacking = scale.asDiagonal() * (full - weight) * scale.asDiagonal();
  if (lacking.cwiseAbs().maxCoeff() <= kSameWeight) return Eigen::MatrixXd(4, 0);
  const auto [values, vectors] = EigenOfSymmetric(lacking);
  if (values.minCoeff() < -kSameWeight) return std::nullopt;
  const Eigen::Index count = (values.array() > kSameWeight).count();
  return unit.asDiagonal() * (vectors.rightCols(count) * values.tail(count).cwiseSqrt().asDiagonal());
}

/// Columns of what one stop lacks, in the rows of the unknowns.
void AddLacking(const Design& design, int setup, int target, const Eigen::MatrixXd& root,
                std::vector<Eigen::VectorXd>& columns) {
  const StopModel model = ModelStop(design, setup, target);
  for (Eigen::Index c = 0; c < root.cols(); ++c) {
    Eigen::VectorXd column = Eigen::VectorXd::Zero(design.Unknowns());
    for (int k = 0; k < model.columns; ++k) {
      column[model.column[static_cast<std::size_t>(k)]] = model.d.col(k).dot(root.col(c));
    }
    columns.push_back(std::move(column));
  }
}

/// Columns U with N = N of the full weights - U U^T; nothing if that cannot be, or if they are too many to gain
/// from.
std::optional<Eigen::MatrixXd> Lacking(const Design& design, const std::vector<Cell>& cells,
                                       const std::vector<Matrix4>& full) {
  std::vector<Matrix4> weights(full.size() * static_cast<std::size_t>(design.n), Matrix4::Zero());
  for (const Cell& cell : cells)
    weights[static_cast<std::size_t>(cell.setup * design.n + cell.target)] = cell.weight;
  std::vector<Eigen::VectorXd> columns;
  for (std::size_t stop = 0; stop < weights.size(); ++stop) {
    const int setup = static_cast<int>(stop) / design.n, target = static_cast<int>(stop) % design.n;
    const auto root = RootOfLacking(full[static_cast<std::size_t>(setup)], weights[stop]);
    if (!root) return std::nullopt;
    AddLacking(design, setup, target, *root, columns);
    if (2 * columns.size() > weights.size()) return std::nullopt;
  }
  Eigen::MatrixXd lacking(design.Unknowns(), std::ssize(columns));
  for (std::size_t c = 0; c < columns.size(); ++c) lacking.col(static_cast<Eigen::Index>(c)) = columns[c];
  return lacking;
}

/// Rows of one set-up and part: its four motions.
auto RowsOf(const OrderBlock& block, int setup, int part) {
  const int first = measure::kDofs * setup * block.basis.parts + part;
  return block.d(Eigen::seqN(first, Eigen::fix<measure::kDofs>, block.basis.parts), Eigen::all);
}

Eigen::MatrixXd NormalOf(const OrderBlock& block, const std::vector<Matrix4>& weights) {
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(block.d.cols(), block.d.cols());
  for (std::size_t s = 0; s < weights.size(); ++s) {
    for (int part = 0; part < block.basis.parts; ++part) {
      const Eigen::MatrixXd d = RowsOf(block, static_cast<int>(s), part);
      normal += d.transpose() * weights[s] * d;
    }
  }
  return normal;
}

/// InvertNormal of one order: the target's unknowns eliminated, the rest at unit diagonal with the null space
/// pinned.
/// @param most  Largest diagonal element of the rest, over all orders.
std::optional<Eigen::MatrixXd> InvertOrder(const OrderBlock& block, const Eigen::MatrixXd& normal, double most) {
  const Eigen::Index target = kTargetSeries * block.basis.parts, rest = normal.rows() - target;
  const auto own = InverseOfPositive(normal.topLeftCorner(target, target), 0.0);
  if (!own) return std::nullopt;
  const Eigen::MatrixXd across = normal.topRightCorner(target, rest), coupling = *own * across;
  const Eigen::ArrayXd diagonal = normal.diagonal().tail(rest).array();
  const Eigen::VectorXd scale = (diagonal > kNoOrderWeight * most).select(diagonal, most).rsqrt();
  Eigen::MatrixXd scaled = normal.bottomRightCorner(rest, rest) - across.transpose() * coupling;
  scaled = scale.asDiagonal() * scaled * scale.asDiagonal();
  Eigen::MatrixXd null = scale.cwiseInverse().asDiagonal() * block.null.bottomRows(rest);
  for (auto column : null.colwise()) column /= std::max(column.norm(), 1e-300);
  scaled += null * null.transpose();
  const auto inverse_scaled = InverseOfPositive(scaled, kDefectiveOrder);
  if (!inverse_scaled) return std::nullopt;
  const Eigen::MatrixXd inverse_rest = scale.asDiagonal() * *inverse_scaled * scale.asDiagonal();
  Eigen::MatrixXd inverse(normal.rows(), normal.rows());
  inverse.topLeftCorner(target, target) = *own + coupling * inverse_rest * coupling.transpose();
  inverse.topRightCorner(target, rest) = -coupling * inverse_rest;
  inverse.bottomLeftCorner(rest, target) = inverse.topRightCorner(target, rest).transpose();
  inverse.bottomRightCorner(rest, rest) = inverse_rest;
  return inverse;
}

/// Rows of a series' coefficients in a block, and of its values in the unknowns.
std::vector<int> ValueRows(const Design& design, int series) {
  std::vector<int> rows;
  for (int i = 0; i < design.n; ++i) rows.push_back(design.Column(static_cast<Series>(series), i));
  return rows;
}

using Coefficients = std::vector<Eigen::VectorXd>;  // of each order, in the columns of its block

void Transform(const Design& design, const Fourier& fourier, const std::vector<OrderBlock>& blocks,
               const Eigen::VectorXd& unknowns, Coefficients& coefficients) {
  for (int k = 0; k < kSeries; ++k) {
    const Eigen::VectorXcd X = fourier.Forward(unknowns(ValueRows(design, k)).cast<std::complex<double>>());
    for (std::size_t m = 0; m < blocks.size(); ++m) {
      const OrderBasis& basis = blocks[m].basis;
      const std::complex<double> wave = X[basis.order] / basis.cos_scale;
      coefficients[m][k * basis.parts] = wave.real();
      if (basis.parts == 2) coefficients[m][k * basis.parts + 1] = -wave.imag();
    }
  }
  for (std::size_t m = 0; m < blocks.size(); ++m) {
    const auto& columns = blocks[m].constant_columns;
    coefficients[m].tail(std::ssize(columns)) = unknowns(columns);
  }
}

void TransformBack(const Design& design, const Fourier& fourier, const std::vector<OrderBlock>& blocks,
                   const Coefficients& coefficients, Eigen::Ref<Eigen::VectorXd> unknowns) {
  for (int k = 0; k < kSeries; ++k) {
    Eigen::VectorXcd X(design.n);
    for (std::size_t m = 0; m < blocks.size(); ++m) {
      const OrderBasis& basis = blocks[m].basis;
      const double c = coefficients[m][k * basis.parts] / basis.cos_scale;
      const double s = basis.parts == 2 ? coefficients[m][k * basis.parts + 1] / basis.cos_scale : 0.0;
      const std::complex<double> wave(c / basis.parts, -s / basis.parts);
      X[basis.order] = wave;
      if (basis.parts == 2) X[design.n - basis.order] = std::conj(wave);
    }
    unknowns(ValueRows(design, k)) = fourier.Backward(X).real();
  }
  for (std::size_t m = 0; m < blocks.size(); ++m) {
    const auto& columns = blocks[m].constant_columns;
    unknowns(columns) = coefficients[m].tail(std::ssize(columns));
  }
}

}  // namespace

std::optional<OrderInverse> OrderInverse::Of(const Design& design, const std::vector<OrderBlock>& blocks,
                                             const std::vector<Cell>& cells) {
  const std::vector<Matrix4> weights = FullWeights(design, cells);
  const auto lacking = Lacking(design, cells, weights);
  if (!lacking) return std::nullopt;
  std::vector<Eigen::MatrixXd> normals;
  double most = 0.0;
  for (const OrderBlock& block : blocks) {
    normals.push_back(NormalOf(block, weights));
    most = std::max(most,
                    normals.back().diagonal().tail(block.d.cols() - kTargetSeries * block.basis.parts).maxCoeff());
  }
  OrderInverse result(design, blocks);
  for (std::size_t m = 0; m < blocks.size(); ++m) {
    auto inverse = InvertOrder(blocks[m], normals[m], most);
    if (!inverse) return std::nullopt;
    result.inverse_.push_back(*std::move(inverse));
  }
  if (!result.TakeOut(*lacking)) return std::nullopt;
  return result;
}

/// (N - U U^T)^-1 = G + G U (I - U^T G U)^-1 U^T G with G = N^-1. False if a direction has no weight left.
bool OrderInverse::TakeOut(const Eigen::MatrixXd& lacking) {
  missing_.resize(design_.Unknowns(), 0);
  if (lacking.cols() == 0) return true;
  const Eigen::MatrixXd across = TimesWithoutGaps(lacking);
  const Eigen::MatrixXd unit = Eigen::MatrixXd::Identity(lacking.cols(), lacking.cols());
  const auto [left, vectors] = EigenOfSymmetric(unit - lacking.transpose() * across);
  if (!(left.minCoeff() > kLeastLeft)) return false;
  missing_ = across * vectors * left.cwiseSqrt().cwiseInverse().asDiagonal();
  return true;
}

Eigen::MatrixXd OrderInverse::operator*(const Eigen::MatrixXd& right) const {
  return TimesWithoutGaps(right) + missing_ * (missing_.transpose() * right);
}

Eigen::MatrixXd OrderInverse::TimesWithoutGaps(const Eigen::MatrixXd& right) const {
  const Fourier fourier(design_.n);
  Coefficients coefficients;
  for (const OrderBlock& block : blocks_) coefficients.emplace_back(block.d.cols());
  Eigen::MatrixXd x(right.rows(), right.cols());
  for (Eigen::Index c = 0; c < right.cols(); ++c) {
    Transform(design_, fourier, blocks_, right.col(c), coefficients);
    for (std::size_t m = 0; m < blocks_.size(); ++m) coefficients[m] = (inverse_[m] * coefficients[m]).eval();
    TransformBack(design_, fourier, blocks_, coefficients, x.col(c));
  }
  return x;
}

void OrderInverse::Scale(double variance) {
  for (Eigen::MatrixXd& inverse : inverse_) inverse *= variance;
  missing_ *= std::sqrt(variance);
}

std::vector<Vector4> OrderInverse::FittedVariances(const std::vector<Cell>& cells,
                                                   const std::vector<StopModel>& models) const {
  const std::vector<Vector4> of_setup = FittedWithoutGaps();
  std::vector<Vector4> variances;
  for (std::size_t k = 0; k < cells.size(); ++k) {
    variances.push_back(of_setup[static_cast<std::size_t>(cells[k].setup)]);
    if (missing_.cols() == 0) continue;
    const std::vector<int> columns(models[k].column.begin(), models[k].column.begin() + models[k].columns);
    const Eigen::MatrixXd moved = models[k].d.leftCols(models[k].columns) * missing_(columns, Eigen::all);
    variances.back() += moved.rowwise().squaredNorm();
  }
  return variances;
}

/// The same at all stops of a set-up.
std::vector<Vector4> OrderInverse::FittedWithoutGaps() const {
  std::vector<Vector4> variances(design_.setups.size(), Vector4::Zero());
  for (std::size_t m = 0; m < blocks_.size(); ++m) {
    for (std::size_t s = 0; s < variances.size(); ++s) {
      for (int part = 0; part < blocks_[m].basis.parts; ++part) {
        const Eigen::MatrixXd d = RowsOf(blocks_[m], static_cast<int>(s), part);
        variances[s] += (d * inverse_[m]).cwiseProduct(d).rowwise().sum() / design_.n;
      }
    }
  }
  return variances;
}

/// cos and sin of one order, each with itself and across, give cos and sin of the lag.
Eigen::MatrixXd OrderInverse::Lags(const std::vector<Series>& series,
                                   const std::vector<Eigen::MatrixXd>& removed) const {
  const auto curves = std::ssize(series);
  Eigen::MatrixXcd spectra = Eigen::MatrixXcd::Zero(design_.n, curves * curves);
  for (std::size_t m = 0; m < blocks_.size(); ++m) {
    const int parts = blocks_[m].basis.parts, order = blocks_[m].basis.order;
    std::vector<Eigen::Index> columns;
    for (const Series s : series) {
      for (int part = 0; part < parts; ++part) columns.push_back(static_cast<int>(s) * parts + part);
    }
    const Eigen::MatrixXd& Q = removed[m];
    Eigen::MatrixXd cov = inverse_[m](columns, columns);
    cov -= Q * (Q.transpose() * cov).eval();
    cov -= (cov * Q).eval() * Q.transpose();
    for (Eigen::Index p = 0; p < curves; ++p) {
      for (Eigen::Index q = 0; q < curves; ++q) {
        const auto pair = cov.block(p * parts, q * parts, parts, parts);
        const std::complex<double> wave =
            parts == 1 ? std::complex<double>(pair(0, 0), 0.0)
                       : 0.5 * std::complex<double>(pair(0, 0) + pair(1, 1), pair(1, 0) - pair(0, 1));
        spectra(order, p * curves + q) = wave;
        if (parts == 2) spectra(design_.n - order, p * curves + q) = std::conj(wave);
      }
    }
  }
  const Fourier fourier(design_.n);
  Eigen::MatrixXd lags(design_.n, curves * curves);
  for (Eigen::Index c = 0; c < lags.cols(); ++c) lags.col(c) = fourier.Backward(spectra.col(c)).real() / design_.n;
  return lags;
}

}  // namespace twinbench::separate
