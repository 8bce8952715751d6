#pragma once

namespace twinbench::separate {

/// Fewer degrees of freedom are none: where they come as a sum, the rest is its rounding errors.
inline constexpr double kLeastDof = 0.5;

/// Probability that a chi-squared variable of `dof` degrees of freedom exceeds `chi2`, by the cube-root normal
/// approximation of Wilson and Hilferty (1931): within 15 % of itself at p = 0.001 for dof >= 3. NaN unless dof >
/// 0.
double ChiSquaredExceedance(double chi2, double dof);

}  // namespace twinbench::separate
