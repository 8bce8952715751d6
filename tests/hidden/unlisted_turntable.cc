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
  const int order = draw.Whole(2, 5);
  const double phase = draw.Phase();
  const auto map = [&](std::size_t i) {
    return draw.readings[i].direction * std::cos(order * draw.readings[i].target_rad + phase);
  };
  return OnAxis(axis, {"direction"}, draw.FullCircleSeries(map));
}

/// Draughts that come and go: straight between random levels some minutes apart.
UnlistedSignal SlowWander(const Draw& draw) {
  const std::string axis = AnyAxis(draw);
  const double minutes = UniformIn(draw.stream, 3.0, 8.0);
  std::vector<double> levels;
  for (int k = 0; k < 200; ++k) levels.push_back(draw.of_run.Normal());
  const auto wander = [&](std::size_t i) {
    const double at = 60.0 * draw.Hours(i) / minutes;
    const auto k = static_cast<std::size_t>(at) % (levels.size() - 1);
    return levels[k] + (at - std::floor(at)) * (levels[k + 1] - levels[k]);
  };
  return OnAxis(axis, {"time"}, draw.Series(wander));
}

/// Something that was leant against the stand for one pass.
UnlistedSignal OnePassAside(const Draw& draw) {
  const std::string axis = AnyAxis(draw);
  const int pass = draw.Whole(2, 6), order = draw.Whole(1, 3);
  const double phase = draw.Phase();
  const auto aside = [&](std::size_t i) {
    return draw.readings[i].pass == pass ? std::cos(order * draw.readings[i].target_rad + phase) : 0.0;
  };
  return OnAxis(axis, {"pass", "time", "set-up"}, draw.FullCircleSeries(aside));
}

}  // namespace

const std::vector<UnlistedCause>& TurntableUnlistedCauses() {
  static const std::vector<UnlistedCause> causes = {{"direction times order", TurntableDirectionMap},
                                                    {"slow wander", SlowWander},
                                                    {"one pass aside", OnePassAside}};
  return causes;
}

}  // namespace twinbench::hidden
