#include "twin/model/wave_sums.h"

#include <bit>
#include <cmath>
#include <complex>
#include <unsupported/Eigen/FFT>

#include "twin/core/units.h"

namespace twinbench::model {
namespace {

constexpr int kReach = 16;               // points that a reading is spread over
constexpr double kShape = 2.3 * kReach;  // the best for a grid of twice as many points as sums

/// The spreading, z from -1 to 1 over its reach; zero beyond.
double Spreading(double z) {
  const double inside = 1.0 - z * z;
  return inside > 0.0 ? std::exp(kShape * (std::sqrt(inside) - 1.0)) : 0.0;
}

/// Its Fourier integral at a wave of `rad` from one point to the next. The trapezoidal rule is exact to rounding
/// for a function that is smooth and all but zero at both ends.
double TransformOf(double rad) {
  constexpr int kParts = 4 * kReach / 2;  // of a quarter of a point each
  const double half = 0.5 * kReach, width = half / kParts;
  double sum = Spreading(0.0);
  for (int k = 1; k < kParts; ++k)
    sum += 2.0 * Spreading(static_cast<double>(k) / kParts) * std::cos(rad * width * k);
  return sum * width;
}

int GridFor(int count) {
  return static_cast<int>(std::bit_ceil(static_cast<unsigned>(std::max(2 * count, 2 * kReach))));
}

/// Adds each value, spread over kReach points from its place on, to a grid of pairs: cosine and sine.
[[gnu::target_clones("avx512f", "avx2", "default")]] void SpreadAll(const double* __restrict values,
                                                                    const int* __restrict from,
                                                                    const double* __restrict share,
                                                                    Eigen::Index count, double* __restrict grid) {
  for (Eigen::Index i = 0; i < count; ++i, share += kReach) {
    const double cosine = values[2 * i], sine = values[2 * i + 1];
    double* const at = grid + 2 * from[i];
    for (int k = 0; k < kReach; ++k) {
      at[2 * k] += share[k] * cosine;
      at[2 * k + 1] += share[k] * sine;
    }
  }
}

}  // namespace

WaveSums::WaveSums(const Eigen::VectorXd& phase_rad, double first, double step, int count)
    : count_(count),
      size_(GridFor(count)),
      turned_(phase_rad.size()),
      from_(static_cast<std::size_t>(phase_rad.size())),
      share_(kReach, phase_rad.size()),
      undo_(count) {
  const int middle = count / 2;
  for (Eigen::Index i = 0; i < phase_rad.size(); ++i) {
    turned_[i] = std::polar(1.0, (first + middle * step) * phase_rad[i]);
    const double turns = step * phase_rad[i] / units::turn, at = (turns - std::floor(turns)) * size_;
    const double begin = std::ceil(at - 0.5 * kReach);
    from_[static_cast<std::size_t>(i)] = static_cast<int>(begin) + kReach;  // behind a margin
    for (int k = 0; k < kReach; ++k) share_(k, i) = Spreading((begin + k - at) / (0.5 * kReach));
  }
  for (int g = 0; g < count; ++g) undo_[g] = 1.0 / TransformOf(units::turn * (g - middle) / size_);
}

Eigen::MatrixXcd WaveSums::Of(const Eigen::MatrixXd& y) const {
  Eigen::VectorXcd values, grid(size_ + 2 * kReach);  // with a margin of kReach points on either side
  Eigen::FFT<double> fft;
  fft.SetFlag(Eigen::FFT<double>::Unscaled);
  Eigen::VectorXcd round(size_), transform(size_);
  Eigen::MatrixXcd sums(count_, y.cols());
  const int middle = count_ / 2;
  for (Eigen::Index j = 0; j < y.cols(); ++j) {
    values = turned_.cwiseProduct(y.col(j));
    grid.setZero();
    SpreadAll(reinterpret_cast<const double*>(values.data()), from_.data(), share_.data(), values.size(),
              reinterpret_cast<double*>(grid.data()));
    round = grid.segment(kReach, size_);
    round.head(kReach) += grid.tail(kReach);
    round.tail(kReach) += grid.head(kReach);
    fft.inv(transform, round);
    for (int g = 0; g < count_; ++g) sums(g, j) = undo_[g] * transform[(g - middle + size_) % size_];
  }
  return sums;
}

}  // namespace twinbench::model
