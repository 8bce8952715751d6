#include "twin/model/wave_grid.h"

#include <cmath>
#include <complex>

namespace twinbench::model {
namespace {

/// exp(i (first + k * step) * phase): readings x count.
Eigen::ArrayXXcd Rotations(const Eigen::VectorXd& phase_rad, double first, double step, int count) {
  Eigen::ArrayXXcd rotations(phase_rad.size(), count);
  for (int k = 0; k < count; ++k) {
    rotations.col(k) =
        phase_rad.array().unaryExpr([factor = first + k * step](double p) { return std::polar(1.0, factor * p); });
  }
  return rotations;
}

}  // namespace

WaveGrid::WaveGrid(const Eigen::VectorXd& phase_rad, double first, double step, int count)
    : stride_(static_cast<int>(std::ceil(std::sqrt(count)))),
      coarse_(Rotations(phase_rad, first, stride_ * step, (count + stride_ - 1) / stride_)),
      fine_(Rotations(phase_rad, 0.0, step, stride_)) {}

Eigen::MatrixXd WaveGrid::At(int g) const {
  const Eigen::ArrayXcd wave = coarse_.col(g / stride_) * fine_.col(g % stride_);
  Eigen::MatrixXd columns(wave.size(), 2);
  columns << wave.real().matrix(), wave.imag().matrix();
  return columns;
}

}  // namespace twinbench::model
