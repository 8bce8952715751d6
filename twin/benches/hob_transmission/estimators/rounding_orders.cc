#include "twin/benches/hob_transmission/estimators/rounding_orders.h"

#include <complex>

namespace twinbench::separate::hob {

std::vector<double> AddRounding(const Eigen::VectorXd& th_rad, const Eigen::MatrixXd& waves,
                                harmonics::HarmonicSeries& series) {
  std::vector<double> added_rad2;
  for (int k = 1; k <= series.Highest(); ++k) {
    const Eigen::VectorXcd order = (std::complex<double>(0.0, -k) * th_rad.array()).exp() * 2.0 / static_cast<double>(th_rad.size());
    const Eigen::RowVectorXcd sums = order.transpose() * waves;
    Eigen::Matrix<double, 2, Eigen::Dynamic> parts(2, waves.cols());
    parts << sums.real(), sums.imag();
    series.At(k).cov += parts * parts.transpose();
    added_rad2.push_back(0.5 * parts.squaredNorm());
  }
  return added_rad2;
}

}  // namespace twinbench::separate::hob
