#include "twin/diagnose/engine/projector.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

#include "twin/core/errors.h"
#include "twin/diagnose/engine/scan_kernels.h"

namespace twinbench::diagnose {
namespace {

using Sparse = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// Whether sparse arithmetic would only get in the way.
bool IsDense(const Sparse& jacobian) {
  constexpr double kDense = 0.2;
  return static_cast<double>(jacobian.nonZeros()) >
         kDense * static_cast<double>(jacobian.rows()) * static_cast<double>(jacobian.cols());
}

/// J'J of a few hundred unknowns.
Eigen::MatrixXd Gram(const Sparse& jacobian) {
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(jacobian.cols(), jacobian.cols());
  for (int k = 0; k < jacobian.rows(); ++k) {
    for (Sparse::InnerIterator a(jacobian, k); a; ++a) {
      for (Sparse::InnerIterator b(jacobian, k); b; ++b) normal(a.col(), b.col()) += a.value() * b.value();
    }
  }
  return normal;
}

/// D. A prior wider than a million times what the data resolve is no knowledge, but it would cost the factor its
/// sign.
Eigen::VectorXd PrecisionOf(const Eigen::MatrixXd& gram, const Eigen::VectorXd& prior_precision) {
  constexpr double kLeastShare = 1e-12;
  return prior_precision.cwiseMax(kLeastShare * gram.diagonal());
}

/// True if no entry of the normal matrix joins two of the local blocks. Noise that is correlated from reading to
/// reading joins neighbours when it is whitened.
bool AreSeparate(const Eigen::MatrixXd& normal, int blocks, int size) {
  for (int i = 0; i < blocks; ++i) {
    const auto before = normal.block(i * size, 0, size, i * size);
    if ((before.array() != 0.0).any()) return false;
  }
  return true;
}

Eigen::MatrixXd Factor(const Eigen::MatrixXd& positive) {
  const Eigen::LLT<Eigen::MatrixXd> llt(positive);
  Require(llt.info() == Eigen::Success, "the normal matrix of the free unknowns is not positive definite");
  return llt.matrixL();
}

}  // namespace

Projector::Projector(Sparse jacobian, const Nuisance& nuisance)
    : jacobian_(std::move(jacobian)), blocks_(nuisance.blocks), size_(nuisance.block_size) {
  Require(nuisance.prior_precision.size() == jacobian_.cols() && (nuisance.prior_precision.array() > 0.0).all(),
          "every free unknown needs a positive prior precision");
  if (IsDense(jacobian_)) dense_ = jacobian_;
  Eigen::MatrixXd normal = dense_.size() > 0 ? dense_.transpose() * dense_ : Gram(jacobian_);
  const Eigen::VectorXd precision = PrecisionOf(normal, nuisance.prior_precision);
  normal.diagonal() += precision;
  if (!AreSeparate(normal, blocks_, size_)) blocks_ = 0;
  const int local = blocks_ * size_, core = static_cast<int>(normal.cols()) - local;
  coupling_.resize(core, local);
  for (int i = 0; i < blocks_; ++i) {
    const int at = i * size_;
    local_.push_back(Factor(normal.block(at, at, size_, size_)));
    coupling_.middleCols(at, size_) =
        local_.back().triangularView<Eigen::Lower>().solve(normal.block(at, local, size_, core)).transpose();
  }
  core_ = Factor(normal.bottomRightCorner(core, core) - coupling_ * coupling_.transpose());
  // tr W = rows - tr (J'J + D)^-1 J'J = rows - unknowns + tr (J'J + D)^-1 D
  const Eigen::MatrixXd weak = Forward(precision.cwiseSqrt().asDiagonal());
  degrees_of_freedom_ = static_cast<double>(jacobian_.rows() - jacobian_.cols()) + weak.squaredNorm();
}

Eigen::MatrixXd Projector::Forward(Eigen::MatrixXd b) const {
  for (int i = 0; i < blocks_; ++i) {
    auto rows = b.middleRows(i * size_, size_);
    local_[static_cast<std::size_t>(i)].triangularView<Eigen::Lower>().solveInPlace(rows);
  }
  const Eigen::Index local = coupling_.cols();
  auto rest = b.bottomRows(coupling_.rows());
  rest.noalias() -= coupling_ * b.topRows(local);
  core_.triangularView<Eigen::Lower>().solveInPlace(rest);
  return b;
}

Eigen::MatrixXd Projector::Backward(Eigen::MatrixXd h) const {
  const Eigen::Index local = coupling_.cols();
  auto rest = h.bottomRows(coupling_.rows());
  core_.triangularView<Eigen::Lower>().transpose().solveInPlace(rest);
  h.topRows(local).noalias() -= coupling_.transpose() * rest;
  for (int i = 0; i < blocks_; ++i) {
    auto rows = h.middleRows(i * size_, size_);
    local_[static_cast<std::size_t>(i)].triangularView<Eigen::Lower>().transpose().solveInPlace(rows);
  }
  return h;
}

/// A row of S at a time. Many signatures are zero on many rows (before a step, on other channels): what lies beside the
/// first and last of a row that are not costs nothing here.
RunsByRow Projector::Gathered(const RunsByRow& S, RowsOf which) const {
  if (dense_.size() > 0) return TransposedProduct(dense_(Eigen::seqN(which.first, S.rows(), which.stride), Eigen::all), S);
  RunsByRow gathered = RunsByRow::Zero(jacobian_.cols(), S.cols());
  for (Eigen::Index row = 0; row < S.rows(); ++row) {
    const double* const begin = S.row(row).data();
    const double* const end = begin + S.cols();
    const auto is_there = [](double value) { return value != 0.0; };
    const double* const first = std::find_if(begin, end, is_there);
    if (first == end) continue;
    const double* const last =
        std::find_if(std::make_reverse_iterator(end), std::make_reverse_iterator(first), is_there).base();
    for (Sparse::InnerIterator j(jacobian_, which.first + row * which.stride); j; ++j)
      AddScaled(j.value(), first, last - first, gathered.row(j.col()).data() + (first - begin));
  }
  return gathered;
}

Eigen::MatrixXd Projector::Absorbed(const Eigen::MatrixXd& S) const {
  return Forward(Gathered(S, RowsOf{}));
}

Eigen::MatrixXd Projector::Solve(const Eigen::MatrixXd& Y) const {
  return Backward(Absorbed(Y));
}

Eigen::MatrixXd Projector::Apply(const Eigen::MatrixXd& Y) const {
  return Y - jacobian_ * Solve(Y);
}

/// Splits L^-1 of one row of the Jacobian: `core` (zero before) gets the right-hand side of the core unknowns.
/// @return the squared length of the local part; a row touches one block at most.
double Projector::EliminateLocal(int row, Eigen::Ref<Eigen::VectorXd> core) const {
  const Eigen::Index local = coupling_.cols();
  Eigen::VectorXd own = Eigen::VectorXd::Zero(size_);
  int block = -1;
  for (Sparse::InnerIterator it(jacobian_, row); it; ++it) {
    if (it.col() >= local) {
      core[it.col() - local] = it.value();
    } else {
      block = static_cast<int>(it.col()) / size_;
      own[it.col() % size_] = it.value();
    }
  }
  if (block < 0) return 0.0;
  local_[static_cast<std::size_t>(block)].triangularView<Eigen::Lower>().solveInPlace(own);
  core.noalias() -= coupling_.middleCols(block * size_, size_) * own;
  return own.squaredNorm();
}

Eigen::VectorXd Projector::Redundancy(const std::vector<int>& rows) const {
  constexpr Eigen::Index kChunk = 256;  // the core's solve is a matrix product, in the cache
  const auto count = std::ssize(rows);
  Eigen::VectorXd leverage(count);
  for (Eigen::Index first = 0; first < count; first += kChunk) {
    const Eigen::Index now = std::min<Eigen::Index>(kChunk, count - first);
    Eigen::MatrixXd core = Eigen::MatrixXd::Zero(coupling_.rows(), now);
    for (Eigen::Index k = 0; k < now; ++k) {
      leverage[first + k] = EliminateLocal(rows[static_cast<std::size_t>(first + k)], core.col(k));
    }
    core_.triangularView<Eigen::Lower>().solveInPlace(core);
    leverage.segment(first, now) += core.colwise().squaredNorm().transpose();
  }
  return 1.0 - leverage.array();
}

Eigen::VectorXd Projector::Redundancy() const {
  std::vector<int> rows(static_cast<std::size_t>(jacobian_.rows()));
  std::iota(rows.begin(), rows.end(), 0);
  return Redundancy(rows);
}

}  // namespace twinbench::diagnose
