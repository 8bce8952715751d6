#pragma once

#include <Eigen/Core>

namespace twinbench::diagnose::screen {

/// Sums over readings of series * exp(-i 2 pi f (time - first time)) at f = step, 2 step, ..., count * step: cosine
/// in the real part, minus sine in the imaginary one. Times may be uneven.
///
/// @param series  Readings x columns.
/// @return count x columns, to 1e-6 of the root of readings times the norm of a column.
///
/// Each value is spread over a regular grid by a Gaussian whose transform is divided out after the FFT, so that it
/// costs readings + count log count a column. Source: Greengard and Lee, SIAM Review 46 (2004) 443-454.
Eigen::MatrixXcd Spectrum(const Eigen::VectorXd& time_s, const Eigen::MatrixXd& series, double step_Hz, int count);

}  // namespace twinbench::diagnose::screen
