#include "twin/core/distributions.h"

#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <boost/math/special_functions/erf.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <limits>
#include <numbers>

namespace twinbench {
namespace {

/// Boost takes a gamma function of all degrees of freedom on the way to a probability of 1, and throws where it
/// overflows though the probability does not depend on it.
using NoOverflow = boost::math::policies::policy<
    boost::math::policies::overflow_error<boost::math::policies::ignore_error>>;

}  // namespace

double ChiSquaredExceedance(double chi2, double dof) {
  if (!(dof > 0.0) || std::isnan(chi2)) return std::numeric_limits<double>::quiet_NaN();
  if (!(chi2 > 0.0)) return 1.0;  // nothing is left, but for the rounding error of a difference
  return std::isinf(chi2) ? 0.0 : boost::math::gamma_q(0.5 * dof, 0.5 * chi2, NoOverflow());
}

double VarianceRatioExceedance(double ratio, double dof, double dof_below) {
  if (!(dof > 0.0) || !(dof_below > 0.0) || std::isnan(ratio)) return std::numeric_limits<double>::quiet_NaN();
  return boost::math::ibeta(0.5 * dof_below, 0.5 * dof, dof_below / (dof_below + dof * std::max(ratio, 0.0)));
}

double NormalExceededWith(double probability) {
  if (!(probability >= 0.0 && probability <= 1.0)) return std::numeric_limits<double>::quiet_NaN();
  return std::sqrt(2.0) * boost::math::erfc_inv(2.0 * probability, NoOverflow());
}

double NormalLogDensity(double value, double scale) {
  return -0.5 * value * value / (scale * scale) - std::log(scale) - 0.5 * std::log(2.0 * std::numbers::pi);
}

double LogGamma(double x) {
  int sign = 0;
  return ::lgamma_r(x, &sign);
}

double StudentLogDensity(double value, double dof, double scale) {
  return LogGamma(0.5 * (dof + 1.0)) - LogGamma(0.5 * dof) - 0.5 * std::log(dof * std::numbers::pi) -
         std::log(scale) - 0.5 * (dof + 1.0) * std::log1p(value * value / (dof * scale * scale));
}

double Median(std::vector<double> values) {
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace twinbench
