#pragma once

namespace twinbench {

/// Probability that a chi-squared variable of `dof` degrees of freedom (any positive number) exceeds `chi2`; NaN
/// unless dof > 0. Exact to rounding (Boost.Math's regularised incomplete gamma function).
double ChiSquaredExceedance(double chi2, double dof);

/// The value that a standard normal variable exceeds with this probability, between 0 and 1.
double NormalExceededWith(double probability);

}  // namespace twinbench
