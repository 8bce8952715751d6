#pragma once

#include <Eigen/Core>

#include "twin/model/wave_sums.h"

/// Statistics of residuals, which are of mean zero by their model.
namespace twinbench::diagnose::screen {

/// Deviation of the number of runs of one sign from that of independent signs, in standard deviations; 0 if all
/// have one sign. Wald and Wolfowitz, Ann. Math. Statist. 11 (1940) 147-162.
double RunsScore(const Eigen::VectorXd& series);

/// sum r_i r_(i+lag) / sum r_i^2 for lags 1 to `lags`; 0 of a series that is zero.
Eigen::VectorXd Autocorrelation(const Eigen::VectorXd& series, int lags);

/// n (n + 2) sum r_k^2 / (n - k): chi-squared of as many degrees of freedom as lags.
/// Ljung and Box, Biometrika 65 (1978) 297-303.
double LjungBox(const Eigen::VectorXd& autocorrelation, Eigen::Index readings);

/// Powers of waves at step, 2 step, ..., count * step radians a unit of `at`, which may be uneven: what the least
/// squares of a sine take off the sum of squares, over twice the mean square. White noise: exponential of mean 1.
/// Lomb 1976; Scargle, Astrophys. J. 263 (1982) 835-853, by the sums of Press and Rybicki, ibid. 338 (1989)
/// 277-280.
class LombScargle {
 public:
  LombScargle(const Eigen::VectorXd& at, double step, int count);

  /// @param series  Readings x any.
  /// @return count x columns; 0 of a column that is zero.
  Eigen::MatrixXd Of(const Eigen::MatrixXd& series) const;

 private:
  model::WaveSums sums_;
  Eigen::ArrayXcd turn_;                  // by wave: exp(-i of the phase that makes cosine and sine orthogonal)
  Eigen::ArrayXd per_cosine_, per_sine_;  // one over their sums of squares; 0 of one that is zero at all readings
};

/// Skewness m3 / m2^1.5 and kurtosis m4 / m2^2 by central moments, 0 and 3 of a constant.
struct Shape {
  double skewness = 0.0, kurtosis = 3.0;
};
Shape ShapeOf(const Eigen::VectorXd& values);

/// n / 6 (skewness^2 + (kurtosis - 3)^2 / 4): near chi-squared of 2 degrees of freedom in long normal samples.
/// Jarque and Bera, Economics Letters 6 (1980) 255-259.
double JarqueBera(const Shape& shape, Eigen::Index readings);

/// Bartlett's statistic of equal variances: near chi-squared of one degree of freedom less than groups.
/// Bartlett, Proc. R. Soc. A 160 (1937) 268-282.
/// @param squares  Sum of squares of each group, at least two.
/// @param dof      Degrees of freedom of each, positive.
double Bartlett(const Eigen::ArrayXd& squares, const Eigen::ArrayXd& dof);

/// Standard normal deviate as improbable as chi2 of `dof` degrees of freedom (Wilson and Hilferty 1931).
double NormalScore(double chi2, double dof);

}  // namespace twinbench::diagnose::screen
