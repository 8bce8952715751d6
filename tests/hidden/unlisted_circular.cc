#include <cmath>

#include "tests/hidden/unlisted_cause.h"

// Causes of circles under bar and grid that the catalogue lacks.
namespace twinbench::hidden {
namespace {

UnlistedSignal OnEither(const Draw& draw, const std::vector<std::string>& locks, const Eigen::VectorXd& series) {
  return OnColumn(draw.Whole(0, 1), 2, locks, series);
}

/// A bearing at the foot of the bar: it goes on turning from pass to pass, so that its angle is the one travelled.
UnlistedSignal TravelledLine(const Draw& draw) {
  const double order = UniformIn(draw.stream, 2.3, 5.7), phase = draw.Phase();
  double travelled_rad = 0.0;
  Eigen::VectorXd series(static_cast<Eigen::Index>(draw.readings.size()));
  for (std::size_t i = 0; i < draw.readings.size(); ++i) {
    if (i > 0 && draw.readings[i].pass == draw.readings[i - 1].pass)
      travelled_rad += draw.readings[i].target_rad - draw.readings[i - 1].target_rad;
    series[static_cast<Eigen::Index>(i)] = std::cos(order * travelled_rad + phase);
  }
  return OnEither(draw, {"angle", "per turn"}, series);
}

/// A seat that is a little elsewhere every time a pass begins.
UnlistedSignal SeatOfEachPass(const Draw& draw) {
  std::vector<double> seats;
  for (int k = 0; k < 200; ++k) seats.push_back(draw.of_run.Normal());
  const auto seat = [&](std::size_t i) {
    return seats[static_cast<std::size_t>(10 * draw.readings[i].setup + draw.readings[i].pass)];
  };
  return OnEither(draw, {"pass", "time"}, draw.Series(seat));
}

UnlistedSignal CircleDirectionMap(const Draw& draw) {
  const Draw::Value map = draw.DirectionMap(&Reading::target_rad, 4, 8);
  return OnEither(draw, {"direction"}, draw.Series(map));
}

/// Something that is warm while a set-up lasts.
UnlistedSignal CircleWander(const Draw& draw) {
  const Draw::Value wander = draw.Wander(4.0, 9.0);
  return OnEither(draw, {"time", "pass"}, draw.Series(wander));
}

}  // namespace

const std::vector<UnlistedCause>& CircularUnlistedCauses() {
  static const std::vector<UnlistedCause> causes = {{"line of the travelled angle", TravelledLine},
                                                    {"seat of each pass", SeatOfEachPass},
                                                    {"direction times order", CircleDirectionMap},
                                                    {"slow wander", CircleWander}};
  return causes;  // constant
}

}  // namespace twinbench::hidden
