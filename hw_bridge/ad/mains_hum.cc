#include "hw_bridge/ad/mains_hum.h"

#include <cmath>

#include "twin/core/units.h"

namespace twinbench::hw {
namespace {

/// Sums over the scans of a block; sine and cosine are s and c, a code is x.
struct Sums {
  double n = 0, s = 0, c = 0, ss = 0, cc = 0, sc = 0;
  std::array<double, kChannels> x{}, xs{}, xc{};
};

Sums SumsOf(std::span<const std::int16_t> raw, double step_rad) {
  Sums sum;
  for (std::size_t i = 0; i + kChannels <= raw.size(); i += kChannels) {
    const double phase_rad = step_rad * sum.n;
    const double s = std::sin(phase_rad), c = std::cos(phase_rad);
    sum.n += 1.0;
    sum.s += s;
    sum.c += c;
    sum.ss += s * s;
    sum.cc += c * c;
    sum.sc += s * c;
    for (std::size_t k = 0; k < kChannels; ++k) {
      const double x = raw[i + k];
      sum.x[k] += x;
      sum.xs[k] += x * s;
      sum.xc[k] += x * c;
    }
  }
  return sum;
}

}  // namespace

std::array<double, kChannels> MainsAmplitudes_lsb(std::span<const std::int16_t> raw, double scan_rate_Hz,
                                                  double mains_Hz) {
  std::array<double, kChannels> amplitude;
  amplitude.fill(kNaN);
  if (static_cast<double>(raw.size() / kChannels) * mains_Hz < scan_rate_Hz) return amplitude;
  const Sums m = SumsOf(raw, 2.0 * units::kPi * mains_Hz / scan_rate_Hz);
  // Normal equations with the mean eliminated: two by two in sine and cosine.
  const double ss = m.ss - m.s * m.s / m.n, cc = m.cc - m.c * m.c / m.n, sc = m.sc - m.s * m.c / m.n;
  const double determinant = ss * cc - sc * sc;
  for (std::size_t k = 0; k < kChannels; ++k) {
    const double xs = m.xs[k] - m.x[k] * m.s / m.n, xc = m.xc[k] - m.x[k] * m.c / m.n;
    amplitude[k] = std::hypot(xs * cc - xc * sc, xc * ss - xs * sc) / determinant;
  }
  return amplitude;
}

}  // namespace twinbench::hw
