#pragma once

#include <vector>

namespace twinbench {

/// Fewer degrees of freedom are none: where they come as a sum, the rest is its rounding errors.
inline constexpr double kLeastDof = 0.5;

/// Probability that a chi-squared variable of `dof` degrees of freedom (any positive number) exceeds `chi2`; NaN
/// unless dof > 0, and 1 where nothing is left. Exact to rounding (Boost.Math's regularised incomplete gamma function).
double ChiSquaredExceedance(double chi2, double dof);

/// Probability that the ratio of two variances of these degrees of freedom (any positive numbers) that estimate the
/// same exceeds `ratio` (Fisher's F); NaN unless both are positive.
double VarianceRatioExceedance(double ratio, double dof, double dof_below);

/// ln Gamma(x), x > 0. From several threads at once, which std::lgamma must not be: it writes a sign for all of them.
double LogGamma(double x);

/// The value that a standard normal variable exceeds with this probability: infinite at 0 and 1, NaN where it is no probability.
double NormalExceededWith(double probability);

/// Log density of a normal variable of this scale.
double NormalLogDensity(double value, double scale);

/// Log density of Student's t times `scale`.
double StudentLogDensity(double value, double dof, double scale);

/// The value in the middle; of an even number of values the upper one of the two, so that it is always one of them.
/// @param values  Not empty.
double Median(std::vector<double> values);

}  // namespace twinbench
