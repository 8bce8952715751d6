#include "twin/sim/flicker_noise.h"

#include <cmath>

#include "twin/core/stream.h"
#include "twin/core/units.h"

namespace twinbench::sim {
namespace {

constexpr int kDecades = 6, kLinesADecade = 10;
constexpr double kHighest_Hz = 100.0;

}  // namespace

FlickerNoise::FlickerNoise(double sd_a_decade, std::uint64_t seed, const std::string& name)
    : amplitude_(sd_a_decade * std::sqrt(2.0 / kLinesADecade)) {
  if (sd_a_decade == 0.0) return;
  Stream stream(seed, name);
  for (int k = 0; k < kDecades * kLinesADecade; ++k) {
    // Somewhere in its tenth of a decade, so that no two lines are harmonics of each other.
    const double decades = (k + stream.Uniform()) / kLinesADecade;
    const double frequency_Hz = kHighest_Hz * std::pow(10.0, -decades);
    lines_.push_back({units::turn * frequency_Hz, units::turn * stream.Uniform()});
  }
}

double FlickerNoise::At(double time_s) const {
  double sum = 0.0;
  for (const Line& line : lines_) sum += std::sin(line.rate_rad_s * time_s + line.phase_rad);
  return amplitude_ * sum;
}

}  // namespace twinbench::sim
