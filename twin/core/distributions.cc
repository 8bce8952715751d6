#include "twin/core/distributions.h"

#include <boost/math/special_functions/erf.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <limits>

namespace twinbench {

double ChiSquaredExceedance(double chi2, double dof) {
  if (!(dof > 0.0) || std::isnan(chi2)) return std::numeric_limits<double>::quiet_NaN();
  return std::isinf(chi2) ? 0.0 : boost::math::gamma_q(0.5 * dof, 0.5 * chi2);
}

double NormalExceededWith(double probability) {
  return std::sqrt(2.0) * boost::math::erfc_inv(2.0 * probability);
}

}  // namespace twinbench
