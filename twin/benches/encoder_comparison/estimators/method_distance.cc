#include "twin/benches/encoder_comparison/estimators/method_distance.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace twinbench::separate::encoder {

std::string WidenByDistance(const harmonics::HarmonicSeries& rigorous, harmonics::HarmonicSeries& published) {
  const int highest = std::min(published.Highest(), rigorous.Highest());
  // Twice the noise, in variance, and so much more that one of 50 whole spectra of noise has an order above it.
  const double certain = 4.0 + std::log(std::max(1, highest));
  std::string biased;
  for (int order = 1; order <= highest; ++order) {
    harmonics::Coefficient& own = published.At(order);
    const harmonics::Coefficient& other = rigorous.At(order);
    const double distance_rad2 = 0.5 * std::norm(own.value - other.value);
    const double noise_rad2 = std::max(0.0, 0.5 * (own.cov - other.cov).trace());
    if (!(distance_rad2 > certain * noise_rad2)) continue;  // an order that is lost is NaN
    own.cov += (distance_rad2 - noise_rad2) * Eigen::Matrix2d::Identity();
    biased += fmt::format("{}{}", biased.empty() ? "" : ", ", order);
  }
  return biased;
}

std::string BiasNote(const std::string& orders) {
  return "BIASED: the published equations err in orders " + orders +
         " by more than twice the noise; it is part of their uncertainty";
}

}  // namespace twinbench::separate::encoder
