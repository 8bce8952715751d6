#include <cmath>

#include "tests/hidden/unlisted_cause.h"

// Causes of the hobbing machine that the catalogue lacks.
namespace twinbench::hidden {
namespace {

/// A belt or a change gear whose ratio is no whole number.
UnlistedSignal HobNonIntegerLine(const Draw& draw) {
  const double order = draw.Whole(7, 19) + UniformIn(draw.stream, 0.3, 0.7), phase = draw.Phase();
  const auto line = [&](std::size_t i) { return std::cos(order * draw.readings[i].measured_rad + phase); };
  return OnAngle({"per turn"}, draw.Series(line));
}

UnlistedSignal HobDirectionMap(const Draw& draw) {
  const int order = draw.Whole(2, 6);
  const double phase = draw.Phase();
  const auto map = [&](std::size_t i) {
    return draw.readings[i].direction * std::cos(order * draw.readings[i].measured_rad + phase);
  };
  return OnAngle({"direction"}, draw.Series(map));
}

/// A wave in time that is no sine: a cooling pump that switches.
UnlistedSignal Switching(const Draw& draw) {
  const double period_s = UniformIn(draw.stream, 8.0, 20.0), phase = draw.stream.Uniform();
  const auto on_off = [&](std::size_t i) {
    const double at = 3600.0 * draw.Hours(i) / period_s + phase;
    return at - std::floor(at) < 0.4 ? 1.0 : 0.0;
  };
  return OnAngle({"time"}, draw.Series(on_off));
}

}  // namespace

const std::vector<UnlistedCause>& HobUnlistedCauses() {
  static const std::vector<UnlistedCause> causes = {{"non-integer line", HobNonIntegerLine},
                                                    {"direction times order", HobDirectionMap},
                                                    {"switching pump", Switching}};
  return causes;
}

}  // namespace twinbench::hidden
