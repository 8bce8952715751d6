#include <cmath>
#include <map>

#include "tests/hidden/unlisted_cause.h"

// Causes of the rotary bench that the catalogue lacks.
namespace twinbench::hidden {
namespace {

UnlistedSignal PassOffset(const Draw& draw) {
  std::map<std::pair<int, int>, double> offset;
  const auto of_pass = [&](std::size_t i) {
    const std::pair pass{draw.readings[i].setup, draw.readings[i].pass};
    if (!offset.contains(pass)) offset[pass] = draw.of_run.Normal();
    return offset[pass];
  };
  const Eigen::VectorXd series = draw.FullCircleSeries(of_pass);
  return OnChannel(draw.Channel(), {"pass"}, series);
}

/// A series times what one channel shows. It begins at zero: the calibration saw the right gain, or else this would
/// be a wrong gain and hardly more.
UnlistedSignal Gain(const Draw& draw, const std::string& lock, const Draw::Value& excess) {
  const std::size_t c = draw.Channel();
  return OnChannel(c, {lock}, draw.Series([&](std::size_t i) { return excess(i) * draw.Spot_m(i, c); }));
}

UnlistedSignal GainOfTemperature(const Draw& draw) {
  return Gain(draw, "temperature",
              [&](std::size_t i) { return draw.readings[i].temperature_degC - draw.readings[0].temperature_degC; });
}

/// A gain that grows with time and with its square.
UnlistedSignal WarmingGain(const Draw& draw) {
  const double duration_h = draw.Hours(draw.readings.size() - 1);
  return Gain(draw, "time", [&](std::size_t i) {
    const double x = draw.Hours(i) / duration_h;
    return x * (2.0 - x);
  });
}

UnlistedSignal Interharmonic(const Draw& draw) {
  // Of equal orders only the shift would be left, which is a constant of the set-up.
  const int a = draw.Whole(1, 4), b = (a + draw.Whole(0, 2)) % 4 + 1;
  const double phase = draw.Phase();
  const auto wave = [&](std::size_t i) {
    return std::cos(a * draw.readings[i].target_rad + b * draw.readings[i].reference_rad + phase);
  };
  return OnPattern("tilt", {"both angles"}, draw.FullCircleSeries(wave));
}

UnlistedSignal DirectionHarmonic(const Draw& draw) {
  const Draw::Value map = draw.DirectionMap(&Reading::target_rad, 1, 5);
  return OnPattern("roll", {"direction"}, draw.FullCircleSeries(map));
}

UnlistedSignal Fringe(const Draw& draw) {
  const std::size_t c = draw.Channel();
  const double period_m = LogUniformIn(draw.stream, 25e-6, 150e-6), phase = draw.Phase();
  const auto fringe = [&](std::size_t i) {
    return std::cos(2.0 * units::kPi * draw.Spot_m(i, c) / period_m + phase);
  };
  return OnChannel(c, {"spot"}, draw.Series(fringe));
}

UnlistedSignal RandomWalk(const Draw& draw) {
  double at = 0.0;
  const auto walk = [&](std::size_t i) { return at += std::sqrt(draw.StepHours(i)) * draw.of_run.Normal(); };
  return OnPattern("tilt", {"time"}, draw.Series(walk));
}

/// Sum of first-order processes whose time constants are spaced evenly in their logarithm: 1/f between them.
UnlistedSignal Flicker(const Draw& draw) {
  const Eigen::VectorXd constants_h{{0.005, 0.02, 0.08, 0.32, 1.3}};
  Eigen::VectorXd state(constants_h.size());
  for (double& s : state) s = draw.of_run.Normal();
  const Eigen::VectorXd series = draw.Series([&](std::size_t i) {
    for (Eigen::Index k = 0; k < state.size(); ++k) {
      const double keep = std::exp(-draw.StepHours(i) / constants_h[k]);
      state[k] = keep * state[k] + std::sqrt(1.0 - keep * keep) * draw.of_run.Normal();
    }
    return state.sum();
  });
  return OnChannel(draw.Channel(), {"time"}, series);
}

/// Bending by a gradient: follows how fast the temperature changes, smoothed over some minutes.
UnlistedSignal TiltOfHeating(const Draw& draw) {
  constexpr double kSmoothing_h = 0.1;
  double rate_K_h = 0.0;
  const auto smoothed = [&](std::size_t i) {
    if (i == 0) return 0.0;
    const double step_h = draw.StepHours(i);
    const double slope_K_h = (draw.readings[i].temperature_degC - draw.readings[i - 1].temperature_degC) / step_h;
    return rate_K_h += (1.0 - std::exp(-step_h / kSmoothing_h)) * (slope_K_h - rate_K_h);
  };
  return OnPattern("tilt", {"time", "temperature"}, draw.Series(smoothed));
}

/// A direction-dependent pull of the cable that builds up over a pass.
UnlistedSignal WindUp(const Draw& draw) {
  const auto pull = [&](std::size_t i) {
    const Reading& r = draw.readings[i];
    const double along = r.direction > 0 ? r.position / 36.0 : 1.0 - r.position / 36.0;
    return r.direction * (1.0 - std::exp(-5.0 * along));
  };
  return OnPattern("roll", {"direction"}, draw.FullCircleSeries(pull));
}

}  // namespace

const std::vector<UnlistedCause>& RotaryUnlistedCauses() {
  static const std::vector<UnlistedCause> causes = {{"offset per pass", PassOffset},
                                                    {"gain follows temperature", GainOfTemperature},
                                                    {"gain warms up", WarmingGain},
                                                    {"interharmonic tilt", Interharmonic},
                                                    {"directed roll harmonic", DirectionHarmonic},
                                                    {"fringes in spot position", Fringe},
                                                    {"random walk of tilt", RandomWalk},
                                                    {"1/f drift of a channel", Flicker},
                                                    {"tilt follows heating", TiltOfHeating},
                                                    {"wind-up roll", WindUp}};
  return causes;
}

}  // namespace twinbench::hidden
