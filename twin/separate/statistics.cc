#include "twin/separate/statistics.h"

#include <cmath>

#include "twin/core/reading.h"

namespace twinbench::separate {

double ChiSquaredExceedance(double chi2, double dof) {
  if (!(dof > 0.0)) return kNaN;
  const double variance = 2.0 / (9.0 * dof);
  const double z = (std::cbrt(chi2 / dof) - (1.0 - variance)) / std::sqrt(variance);
  return 0.5 * std::erfc(z / std::sqrt(2.0));
}

}  // namespace twinbench::separate
