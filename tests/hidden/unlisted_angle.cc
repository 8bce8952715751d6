#include <cmath>

#include "tests/hidden/unlisted_cause.h"

// Causes that the catalogues of the encoder bench and of the hobbing machine lack.
namespace twinbench::hidden {
namespace {

UnlistedSignal EncoderNonIntegerLine(const Draw& draw) {
  return OnAngle({"per turn"}, draw.Series(draw.LineBetween(&Reading::reference_rad, 2, 12)));
}

UnlistedSignal EncoderDirectionMap(const Draw& draw) {
  return OnAngle({"direction"}, draw.Series(draw.DirectionMap(&Reading::reference_rad, 2, 6)));
}

UnlistedSignal AngleTone(const Draw& draw) {
  const double frequency_Hz = LogUniformIn(draw.stream, 0.01, 0.1), phase = draw.Phase();
  const auto tone = [&](std::size_t i) {
    return std::cos(2.0 * units::kPi * frequency_Hz * 3600.0 * draw.Hours(i) + phase);
  };
  return OnAngle({"time"}, draw.Series(tone));
}

/// A belt or a change gear whose ratio is no whole number.
UnlistedSignal HobNonIntegerLine(const Draw& draw) {
  return OnAngle({"per turn"}, draw.Series(draw.LineBetween(&Reading::measured_rad, 7, 19)));
}

UnlistedSignal HobDirectionMap(const Draw& draw) {
  return OnAngle({"direction"}, draw.Series(draw.DirectionMap(&Reading::measured_rad, 2, 6)));
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

const std::vector<UnlistedCause>& EncoderUnlistedCauses() {
  static const std::vector<UnlistedCause> causes = {{"non-integer line", EncoderNonIntegerLine},
                                                    {"direction times order", EncoderDirectionMap},
                                                    {"tone in time", AngleTone}};
  return causes;
}

const std::vector<UnlistedCause>& HobUnlistedCauses() {
  static const std::vector<UnlistedCause> causes = {{"non-integer line", HobNonIntegerLine},
                                                    {"direction times order", HobDirectionMap},
                                                    {"switching pump", Switching}};
  return causes;
}

}  // namespace twinbench::hidden
