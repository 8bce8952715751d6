#include "twin/diagnose/engine/scan_kernels.h"

#include <algorithm>
#include <cmath>

#include "twin/diagnose/engine/vector_math.h"

namespace twinbench::diagnose {
namespace {

constexpr Eigen::Index kRowsAtOnce = 8;  // so many rows of B stay in the first-level cache

/// product += A'B of whole blocks of kRowsAtOnce rows: each sum is loaded and stored once a block.
[[gnu::target_clones("avx512f", "avx2", "default")]] void AddRows(const double* __restrict A, Eigen::Index stride,
                                                                  Eigen::Index m, const double* __restrict B,
                                                                  Eigen::Index rows, Eigen::Index columns,
                                                                  double* __restrict product) {
  for (Eigen::Index j = 0; j < m; ++j) {
    double* const sum = product + j * columns;
    for (Eigen::Index row = 0; row < rows; row += kRowsAtOnce) {
      const double* const a = A + j * stride + row;
      const double* const b = B + row * columns;
      for (Eigen::Index c = 0; c < columns; ++c) {
        double more = 0.0;
        for (Eigen::Index r = 0; r < kRowsAtOnce; ++r) more += a[r] * b[r * columns + c];
        sum[c] += more;
      }
    }
  }
}

/// Product of one column of A with each of B's, eight sums side by side.
[[gnu::target_clones("avx512f", "avx2", "default")]] void DotEach(const double* __restrict a, const double* __restrict B, Eigen::Index rows,
                                                                  Eigen::Index columns, double* __restrict product) {
  for (Eigen::Index c = 0; c < columns; ++c) {
    const double* const b = B + c * rows;
    double sums[kRowsAtOnce] = {};
    for (Eigen::Index row = 0; row < rows; row += kRowsAtOnce) {
      for (Eigen::Index r = 0; r < kRowsAtOnce; ++r) sums[r] += a[row + r] * b[row + r];
    }
    for (const double sum : sums) product[c] += sum;
  }
}

/// From what is explained of each run to its log Bayes factor, in place.
[[gnu::target_clones("avx512f", "avx2", "default")]] void LogOfShareLeft(const double* __restrict power, double occam,
                                                                         double half, Eigen::Index runs,
                                                                         double* __restrict values) {
  for (Eigen::Index k = 0; k < runs; ++k) {
    const double left = std::max(1.0 - values[k] / power[k], 1e-12);
    values[k] = -occam - half * LogOfPositive(left);
  }
}

[[gnu::target_clones("avx512f", "avx2", "default")]] void AddExponentials(const double* __restrict values,
                                                                          Eigen::Index runs, double* __restrict top,
                                                                          double* __restrict sum) {
  for (Eigen::Index k = 0; k < runs; ++k) {
    const double above = values[k] - top[k], e = ExpOfNegative(-std::abs(above));
    sum[k] = above > 0.0 ? sum[k] * e + 1.0 : sum[k] + e;
    top[k] = std::max(top[k], values[k]);
  }
}

/// Not AddScaled itself: by its name others reach the AVX-512 clone on any processor where clang 14 has compiled
/// it.
[[gnu::target_clones("avx512f", "avx2", "default")]] void AddScaledArray(double factor,
                                                                         const double* __restrict values,
                                                                         Eigen::Index count,
                                                                         double* __restrict sum) {
  for (Eigen::Index k = 0; k < count; ++k) sum[k] += factor * values[k];
}

}  // namespace

RunsByRow TransposedProduct(const Eigen::Ref<const Eigen::MatrixXd>& A, const RunsByRow& B) {
  constexpr Eigen::Index kFew = 16;  // so many columns of B stay in the cache whole, and a column of A beside them
  RunsByRow product = RunsByRow::Zero(A.cols(), B.cols());
  const Eigen::Index whole = A.rows() / kRowsAtOnce * kRowsAtOnce, rest = A.rows() - whole;
  if (B.cols() <= kFew) {
    const Eigen::MatrixXd by_column = B.topRows(whole);
    for (Eigen::Index j = 0; j < A.cols(); ++j) DotEach(A.col(j).data(), by_column.data(), whole, B.cols(), product.row(j).data());
  } else {
    for (Eigen::Index row = 0; row < whole; row += kRowsAtOnce)
      AddRows(A.data() + row, A.outerStride(), A.cols(), B.row(row).data(), kRowsAtOnce, B.cols(), product.data());
  }
  if (rest == 0) return product;
  Eigen::MatrixXd last_A = Eigen::MatrixXd::Zero(kRowsAtOnce, A.cols());
  RunsByRow last_B = RunsByRow::Zero(kRowsAtOnce, B.cols());
  last_A.topRows(rest) = A.bottomRows(rest);
  last_B.topRows(rest) = B.bottomRows(rest);
  AddRows(last_A.data(), kRowsAtOnce, A.cols(), last_B.data(), kRowsAtOnce, B.cols(), product.data());
  return product;
}

void AddScaled(double factor, const double* __restrict values, Eigen::Index count, double* __restrict sum) {
  AddScaledArray(factor, values, count, sum);
}

void LogBayesOf(const Eigen::VectorXd& weight, const RunsByRow& c2, const Eigen::ArrayXd& power, double occam,
                double half, Eigen::ArrayXd& log_bayes) {
  log_bayes.setZero(c2.cols());
  for (Eigen::Index i = 0; i < weight.size(); ++i) log_bayes += weight[i] * c2.row(i).transpose().array();
  LogOfShareLeft(power.data(), occam, half, log_bayes.size(), log_bayes.data());
}

LogMean::LogMean(Eigen::Index runs)
    : top_(Eigen::ArrayXd::Constant(runs, -1e300)), sum_(Eigen::ArrayXd::Zero(runs)) {}

void LogMean::Add(const Eigen::ArrayXd& values) {
  AddExponentials(values.data(), values.size(), top_.data(), sum_.data());
  ++count_;
}

Eigen::ArrayXd LogMean::Value() const {
  return top_ + (sum_ / count_).log();
}

}  // namespace twinbench::diagnose
