#include "tests/hidden/unlisted_cause.h"
#include "twin/benches/freeform_five_axis/columns.h"
#include "twin/benches/names.h"

// Causes that catalogues lack; those of the rotary bench are in unlisted_cause.cc.
namespace twinbench::hidden {
namespace {

/// Of the benches that read one angle.
UnlistedSignal OnAngle(const std::vector<std::string>& locks, const Eigen::VectorXd& series) {
  return OnColumn(0, 1, locks, series);
}

UnlistedSignal OnEither(const Draw& draw, const std::vector<std::string>& locks, const Eigen::VectorXd& series) {
  return OnColumn(draw.Whole(0, 1), 2, locks, series);
}

UnlistedSignal DirectionTimesOrder(const Draw& draw, Draw::Angle angle) {
  return OnAngle({"direction"}, draw.Series(draw.DirectionMap(angle, 2, 6)));
}

UnlistedSignal NonIntegerLine(const Draw& draw, Draw::Angle angle, int first_order, int last_order) {
  return OnAngle({"per turn"}, draw.Series(draw.LineBetween(angle, first_order, last_order)));
}

UnlistedSignal AngleTone(const Draw& draw) {
  const double frequency_Hz = LogUniformIn(draw.stream, 0.01, 0.1), phase = draw.Phase();
  return OnAngle({"time"}, draw.Series([&](std::size_t i) {
    return std::cos(2.0 * units::kPi * frequency_Hz * 3600.0 * draw.Hours(i) + phase);
  }));
}

/// A wave in time that is no sine: a cooling pump that switches.
UnlistedSignal Switching(const Draw& draw) {
  const double period_s = UniformIn(draw.stream, 8.0, 20.0), phase = draw.stream.Uniform();
  return OnAngle({"time"}, draw.Series([&](std::size_t i) {
    const double at = 3600.0 * draw.Hours(i) / period_s + phase;
    return at - std::floor(at) < 0.4 ? 1.0 : 0.0;
  }));
}

/// Something that was leant against the stand for one pass.
UnlistedSignal OnePassAside(const Draw& draw) {
  const int axis = draw.Whole(0, 1);
  const int pass = draw.Whole(2, 6), order = draw.Whole(1, 3);
  const double phase = draw.Phase();
  return OnColumn(axis, 2, {"pass", "time", "mounting"}, draw.FullCircleSeries([&](std::size_t i) {
    return draw.readings[i].pass == pass ? std::cos(order * draw.readings[i].target_rad + phase) : 0.0;
  }));
}

/// A bearing at the foot of the bar: it goes on turning from pass to pass, so that its angle is the one travelled.
UnlistedSignal TravelledLine(const Draw& draw) {
  const double order = UniformIn(draw.stream, 2.3, 5.7), phase = draw.Phase();
  double travelled_rad = 0.0;
  const Eigen::VectorXd series = draw.Series([&](std::size_t i) {
    if (i > 0 && draw.readings[i].pass == draw.readings[i - 1].pass)
      travelled_rad += draw.readings[i].target_rad - draw.readings[i - 1].target_rad;
    return std::cos(order * travelled_rad + phase);
  });
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

using namespace benches::freeform;
constexpr Eigen::Index kProbe = 3;  // channels
constexpr Eigen::Index kCamera = 2;

/// An amplifier whose gain goes with the temperature.
UnlistedSignal WarmGain(const Draw& draw) {
  const bool x = draw.Whole(0, 1) == 0;
  return OnColumn(x ? 0 : 1, kProbe, {"temperature", "reading", "qpd"}, draw.Series([&](std::size_t i) {
    const Reading& r = draw.readings[i];
    return (x ? kQpdX_V(r) : kQpdY_V(r)) * (r.temperature_degC - 20.0);
  }));
}

/// Interference in the window of the camera: a wave of what it shows.
UnlistedSignal Etalon(const Draw& draw) {
  const double period_px = UniformIn(draw.stream, 60.0, 160.0), phase = draw.Phase();
  return OnColumn(kCamera, kProbe, {"reading", "ccd"}, draw.Series([&](std::size_t i) {
    return std::cos(units::turn * kCcd_px(draw.readings[i]) / period_px + phase);
  }));
}

/// A holder that gives way with both swivels at once.
UnlistedSignal BothSwivels(const Draw& draw) {
  return OnColumn(kCamera, kProbe, {"angle", "a ", "b "}, draw.Series([&](std::size_t i) {
    return kCommanded[3](draw.readings[i]) * kCommanded[4](draw.readings[i]);
  }));
}

}  // namespace

const std::vector<UnlistedCause>& UnlistedCausesOf(const std::string& bench) {
  static const std::map<std::string, std::vector<UnlistedCause>> causes = {
      {kRotaryBench, RotaryUnlistedCauses()},
      {kEncoderBench,
       {{"non-integer line",
         [](auto& draw) { return NonIntegerLine(draw, &Reading::reference_rad, 2, 12); }},
        {"direction times order", [](auto& draw) { return DirectionTimesOrder(draw, &Reading::reference_rad); }},
        {"tone in time", AngleTone}}},
      // A belt or a change gear whose ratio is no whole number.
      {kHobBench,
       {{"non-integer line",
         [](auto& draw) { return NonIntegerLine(draw, &Reading::measured_rad, 7, 19); }},
        {"direction times order", [](auto& draw) { return DirectionTimesOrder(draw, &Reading::measured_rad); }},
        {"switching pump", Switching}}},
      // What follows the turntable's position alone is its error. Draughts come and go.
      {kTurntableBench,
       {{"direction times order",
         [](auto& draw) {
           const int axis = draw.Whole(0, 1);
           return OnColumn(axis, 2, {"direction"}, draw.FullCircleSeries(draw.DirectionMap(&Reading::target_rad, 2, 5)));
         }},
        {"slow wander",
         [](auto& draw) {
           const int axis = draw.Whole(0, 1);
           return OnColumn(axis, 2, {"time"}, draw.Series(draw.Wander(3.0, 8.0)));
         }},
        {"one pass aside", OnePassAside}}},
      // Something is warm while a set-up lasts.
      {kCircularBench,
       {{"line of the travelled angle", TravelledLine},
        {"seat of each pass", SeatOfEachPass},
        {"direction times order",
         [](auto& draw) {
           const Draw::Value map = draw.DirectionMap(&Reading::target_rad, 4, 8);
           return OnEither(draw, {"direction"}, draw.Series(map));
         }},
        {"slow wander",
         [](auto& draw) {
           const Draw::Value wander = draw.Wander(4.0, 9.0);
           return OnEither(draw, {"time", "pass"}, draw.Series(wander));
         }}}},
      {kFreeformBench,
       {{"gain with the temperature", WarmGain}, {"etalon", Etalon}, {"product of both swivels", BothSwivels}}}};
  return causes.at(bench);
}

}  // namespace twinbench::hidden
