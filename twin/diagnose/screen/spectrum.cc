#include "twin/diagnose/screen/spectrum.h"

#include <Eigen/SparseCore>
#include <bit>
#include <cmath>
#include <unsupported/Eigen/FFT>
#include <vector>

#include "twin/core/units.h"

namespace twinbench::diagnose::screen {
namespace {

constexpr int kReach = 6;  // grid points on either side of a reading: six digits

struct Grid {
  int size = 0;
  double width = 0.0;  // tau of the paper: the Gaussian is exp(-x^2 / (4 width))
};

Grid GridFor(int count) {
  const auto size = static_cast<int>(std::bit_ceil(static_cast<unsigned>(4 * count + 4 * kReach)));
  const double modes = 2.0 * count, oversampling = size / modes;
  return {size, units::kPi * kReach / (modes * modes * oversampling * (oversampling - 0.5))};
}

/// Share of each reading that the grid points around it get: grid x readings.
Eigen::SparseMatrix<double> Spreading(const Eigen::VectorXd& turns, const Grid& grid) {
  std::vector<Eigen::Triplet<double>> shares;
  for (int i = 0; i < turns.size(); ++i) {
    const double at = (turns[i] - std::floor(turns[i])) * grid.size;
    for (int point = static_cast<int>(at) - kReach + 1; point <= static_cast<int>(at) + kReach; ++point) {
      const double away_rad = (at - point) * (units::turn / grid.size);
      shares.emplace_back((point + grid.size) % grid.size, i, std::exp(-away_rad * away_rad / (4.0 * grid.width)));
    }
  }
  Eigen::SparseMatrix<double> spreading(grid.size, turns.size());
  spreading.setFromTriplets(shares.begin(), shares.end());
  return spreading;
}

}  // namespace

Eigen::MatrixXcd Spectrum(const Eigen::VectorXd& time_s, const Eigen::MatrixXd& series, double step_Hz, int count) {
  const Grid grid = GridFor(count);
  const Eigen::SparseMatrix<double> spreading = Spreading(step_Hz * (time_s.array() - time_s[0]).matrix(), grid);
  const Eigen::ArrayXd order = Eigen::ArrayXd::LinSpaced(count, 1.0, count);
  const Eigen::ArrayXd undo = std::sqrt(units::kPi / grid.width) / grid.size * (order.square() * grid.width).exp();
  Eigen::FFT<double> fft(Eigen::FFT<double>::impl_type(), Eigen::FFT<double>::HalfSpectrum);
  Eigen::VectorXcd transform;
  Eigen::MatrixXcd spectrum(count, series.cols());
  for (Eigen::Index j = 0; j < series.cols(); ++j) {
    fft.fwd(transform, Eigen::VectorXd(spreading * series.col(j)));
    spectrum.col(j) = transform.segment(1, count).array() * undo;
  }
  return spectrum;
}

}  // namespace twinbench::diagnose::screen
