#include <cmath>

#include "tests/hidden/unlisted_cause.h"

// Causes of the turntable bench that the catalogue lacks. What follows the turntable's position alone is its error.
namespace twinbench::hidden {
namespace {

std::string AnyAxis(const Draw& draw) {
  return draw.Whole(0, 1) == 0 ? "x" : "y";
}

UnlistedSignal TurntableDirectionMap(const Draw& draw) {
  const std::string axis = AnyAxis(draw);
  return OnAxis(axis, {"direction"}, draw.FullCircleSeries(draw.DirectionMap(&Reading::target_rad, 2, 5)));
}

/// Draughts that come and go.
UnlistedSignal SlowWander(const Draw& draw) {
  const std::string axis = AnyAxis(draw);
  return OnAxis(axis, {"time"}, draw.Series(draw.Wander(3.0, 8.0)));
}

/// Something that was leant against the stand for one pass.
UnlistedSignal OnePassAside(const Draw& draw) {
  const std::string axis = AnyAxis(draw);
  const int pass = draw.Whole(2, 6), order = draw.Whole(1, 3);
  const double phase = draw.Phase();
  const auto aside = [&](std::size_t i) {
    return draw.readings[i].pass == pass ? std::cos(order * draw.readings[i].target_rad + phase) : 0.0;
  };
  return OnAxis(axis, {"pass", "time", "mounting"}, draw.FullCircleSeries(aside));
}

}  // namespace

const std::vector<UnlistedCause>& TurntableUnlistedCauses() {
  static const std::vector<UnlistedCause> causes = {{"direction times order", TurntableDirectionMap},
                                                    {"slow wander", SlowWander},
                                                    {"one pass aside", OnePassAside}};
  return causes;
}

}  // namespace twinbench::hidden
