#include <cmath>

#include "tests/hidden/unlisted_cause.h"

// Causes of the encoder bench that the catalogue lacks.
namespace twinbench::hidden {
namespace {

UnlistedSignal EncoderNonIntegerLine(const Draw& draw) {
  const int whole = draw.Whole(2, 12);
  const double order = whole + UniformIn(draw.stream, 0.3, 0.7), phase = draw.Phase();
  const auto line = [&](std::size_t i) { return std::cos(order * draw.readings[i].reference_rad + phase); };
  return OnAngle({"per turn"}, draw.Series(line));
}

UnlistedSignal EncoderDirectionMap(const Draw& draw) {
  const int order = draw.Whole(2, 6);
  const double phase = draw.Phase();
  const auto map = [&](std::size_t i) {
    return draw.readings[i].direction * std::cos(order * draw.readings[i].reference_rad + phase);
  };
  return OnAngle({"direction"}, draw.Series(map));
}

UnlistedSignal AngleTone(const Draw& draw) {
  const double frequency_Hz = LogUniformIn(draw.stream, 0.01, 0.1), phase = draw.Phase();
  const auto tone = [&](std::size_t i) {
    return std::cos(2.0 * units::kPi * frequency_Hz * 3600.0 * draw.Hours(i) + phase);
  };
  return OnAngle({"time"}, draw.Series(tone));
}

}  // namespace

const std::vector<UnlistedCause>& EncoderUnlistedCauses() {
  static const std::vector<UnlistedCause> causes = {{"non-integer line", EncoderNonIntegerLine},
                                                    {"direction times order", EncoderDirectionMap},
                                                    {"tone in time", AngleTone}};
  return causes;
}

}  // namespace twinbench::hidden
