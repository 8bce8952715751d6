#include "mechanics/angle_harmonic.h"

#include <cmath>
#include <stdexcept>

namespace twinbench::mechanics {

AngleSeries Evaluate(const std::vector<AngleHarmonic>& harmonics, double angle_rad) {
  AngleSeries sum;
  for (const AngleHarmonic& h : harmonics) {
    const double phase_rad = h.order * angle_rad + h.phase_rad;
    const double even_rad = h.amplitude_rad * std::cos(phase_rad);
    sum.value_rad += even_rad;
    sum.slope -= h.order * h.amplitude_rad * std::sin(phase_rad);
    sum.bend_1_rad -= h.order * h.order * even_rad;
  }
  return sum;
}

void Check(const std::vector<AngleHarmonic>& harmonics, const std::string& where) {
  for (const AngleHarmonic& h : harmonics) {
    if (!std::isfinite(h.order) || !std::isfinite(h.amplitude_rad) || !std::isfinite(h.phase_rad))
      throw std::invalid_argument(where + ": order, amplitude and phase of a harmonic must be finite");
  }
}

}  // namespace twinbench::mechanics
