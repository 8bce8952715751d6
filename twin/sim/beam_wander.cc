#include "twin/sim/beam_wander.h"

#include <cmath>

#include "twin/core/stream.h"
#include "twin/core/units.h"

namespace twinbench::sim {
namespace {

constexpr int kLines = 80;

/// Integral of x^(-2/3) / (1 + x^2): pi from 0 to infinity, less the ends (to 1e-4).
double Variance() {
  return units::kPi - 3.0 * std::cbrt(BeamWander::kLowest) - 0.6 * std::pow(BeamWander::kHighest, -5.0 / 3.0);
}

}  // namespace

BeamWander::BeamWander(double rms, double corner_Hz, std::uint64_t seed, const std::string& name)
    : corner_Hz_(corner_Hz) {
  Stream stream(seed, name);
  const double bin = std::log(kHighest / kLowest) / kLines;  // of the logarithm of the frequency
  for (int k = 0; k < kLines; ++k) {
    // Somewhere in its bin: over the seeds the spectrum is the stated one, without gaps.
    const double x = kLowest * std::exp((k + stream.Uniform()) * bin);
    const double share = bin * std::cbrt(x) / (1.0 + x * x) / Variance();
    lines_.push_back({rms * std::sqrt(2.0 * share), units::turn * x * corner_Hz, units::turn * stream.Uniform()});
  }
}

double BeamWander::At(double time_s) const {
  double sum = 0.0;
  for (const Line& line : lines_) sum += line.amplitude * std::sin(line.rate_rad_s * time_s + line.phase_rad);
  return sum;
}

}  // namespace twinbench::sim
