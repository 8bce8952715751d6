#include "twin/diagnose/screen/spectrum.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>
#include <vector>

namespace twinbench::diagnose::screen {
namespace {

constexpr int kSpreadReach = 6;  // grid points on either side of a reading: six digits

/// Where a reading falls on the grid and the share of each grid point around it.
struct Spread {
  int nearest = 0;
  std::array<double, 2 * kSpreadReach> share{};
};

struct Grid {
  int size = 0;
  double width = 0.0;  // tau of the paper: the Gaussian is exp(-x^2 / (4 width))
};

Grid GridFor(int count) {
  const auto size = static_cast<int>(std::bit_ceil(static_cast<unsigned>(4 * count + 4 * kSpreadReach)));
  const double modes = 2.0 * count, oversampling = size / modes;
  return {size, std::numbers::pi * kSpreadReach / (modes * modes * oversampling * (oversampling - 0.5))};
}

std::vector<Spread> SpreadsOf(const Eigen::VectorXd& turns, const Grid& grid) {
  std::vector<Spread> spreads;
  const double spacing = 2.0 * std::numbers::pi / grid.size;
  for (double turn : turns) {
    const double at = (turn - std::floor(turn)) * grid.size;
    Spread spread{static_cast<int>(at), {}};
    for (int k = 0; k < 2 * kSpreadReach; ++k) {
      const double away = (at - (spread.nearest + k - kSpreadReach + 1)) * spacing;
      spread.share[static_cast<std::size_t>(k)] = std::exp(-away * away / (4.0 * grid.width));
    }
    spreads.push_back(spread);
  }
  return spreads;
}

void Fill(const std::vector<Spread>& spreads, const double* values, Eigen::VectorXd& grid) {
  grid.setZero();
  const auto size = static_cast<int>(grid.size());
  for (std::size_t i = 0; i < spreads.size(); ++i) {
    const int first = spreads[i].nearest - kSpreadReach + 1 + size;
    for (int k = 0; k < 2 * kSpreadReach; ++k) {
      grid[(first + k) % size] += values[i] * spreads[i].share[static_cast<std::size_t>(k)];
    }
  }
}

}  // namespace

Eigen::MatrixXcd Spectrum(const Eigen::VectorXd& time_s, const Eigen::MatrixXd& series, double step_Hz, int count) {
  const Grid grid = GridFor(count);
  const std::vector<Spread> spreads = SpreadsOf(step_Hz * (time_s.array() - time_s[0]).matrix(), grid);
  const Eigen::ArrayXd order = Eigen::ArrayXd::LinSpaced(count, 1.0, count);
  const Eigen::ArrayXd undo =
      std::sqrt(std::numbers::pi / grid.width) / grid.size * (order.square() * grid.width).exp();
  Eigen::FFT<double> fft(Eigen::FFT<double>::impl_type(), Eigen::FFT<double>::HalfSpectrum);
  Eigen::VectorXd values(grid.size);
  Eigen::VectorXcd transform;
  Eigen::MatrixXcd spectrum(count, series.cols());
  for (Eigen::Index j = 0; j < series.cols(); ++j) {
    Fill(spreads, series.col(j).data(), values);
    fft.fwd(transform, values);
    spectrum.col(j) = transform.segment(1, count).array() * undo;
  }
  return spectrum;
}

}  // namespace twinbench::diagnose::screen
