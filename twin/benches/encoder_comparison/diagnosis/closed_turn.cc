#include "twin/benches/encoder_comparison/diagnosis/closed_turn.h"

#include <algorithm>
#include <cmath>

#include "twin/core/distributions.h"
#include "twin/core/reading_clock.h"
#include "twin/core/units.h"

namespace twinbench::diagnose::encoder {

bool IsClosedTurn(const std::vector<Reading>& readings) {
  constexpr std::size_t kFewest =
      256;                       // with fewer, neighbours are too far from each other to say whether it closes
  constexpr double kSame = 8.0;  // usual differences of neighbours
  std::vector<double> reference_rad, error_rad;
  for (const Reading& r : readings) {
    if (r.pass != readings.front().pass || r.setup != readings.front().setup) return false;
    if (!std::isfinite(r.reference_rad) || !std::isfinite(r.measured_rad)) continue;
    reference_rad.push_back(r.reference_rad);
    error_rad.push_back(r.measured_rad - r.reference_rad);
  }
  if (error_rad.size() < kFewest || HasClock(readings)) return false;
  const double step_rad =
      (reference_rad.back() - reference_rad.front()) / static_cast<double>(reference_rad.size() - 1);
  const double beyond_rad = std::abs(reference_rad.back() + step_rad - reference_rad.front()) - units::turn;
  if (std::abs(beyond_rad) > 2.0 * std::abs(step_rad)) return false;
  std::vector<double> apart_rad;
  for (std::size_t i = 1; i < error_rad.size(); ++i)
    apart_rad.push_back(std::abs(std::remainder(error_rad[i] - error_rad[i - 1], units::turn)));
  return std::abs(std::remainder(error_rad.back() - error_rad.front(), units::turn)) <= kSame * Median(apart_rad);
}

}  // namespace twinbench::diagnose::encoder
