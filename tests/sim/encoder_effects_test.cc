#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/input_error.h"
#include "tests/sim/encoder_run.h"
#include "tests/support/kept_text.h"
#include "twin/benches/encoder_comparison/settings.h"

// Each effect of the bench encoder_comparison against its closed form.
namespace twinbench {
namespace {

using test::EncoderEffect, test::EncoderScenario, test::ReadingsWith;
using units::deg;

constexpr double kTiny_rad = 1e-11;  // rounding of angles of some turns

double Error_rad(const Reading& reading) {
  return reading.measured_rad - reading.reference_rad;
}

TEST(EncoderEffects, HarmonicsFollowTheAngleOfTheDevicesScale) {
  Scenario scenario = EncoderScenario();
  EncoderOf(scenario).encoder_procedure.mounting_rad = {50.0 * deg};
  EncoderOf(scenario).device.lines = 90;
  const std::map<std::string, double> size = {{"amplitude", 0.01}, {"phase", 0.5}};
  const auto expect = [&](const EffectSettings& effect, double order) {
    for (const Reading& r : ReadingsWith(scenario, effect)) {
      const double device_rad = r.reference_rad + 50.0 * deg;
      EXPECT_NEAR(r.measured_rad - device_rad, 0.01 * std::cos(order * device_rad + 0.5), 1e-10) << effect.name;
    }
  };
  const auto with = [&](const std::string& name, std::map<std::string, double> more = {}) {
    more.insert(size.begin(), size.end());
    return EncoderEffect(name, more);
  };
  expect(with("eccentricity"), 1.0);
  expect(with("ellipticity"), 2.0);
  expect(with("periodic", {{"order", 5.0}}), 5.0);
  expect(with("gear_mesh", {{"teeth", 11.0}}), 11.0);
  expect(with("interpolation", {{"order", 2.0}}), 180.0);
}

TEST(EncoderEffects, InterpolationNeedsTheLinesOfTheScale) {
  EXPECT_KEPT(MessageOf([] { ReadingsWith(EncoderScenario(), EncoderEffect("interpolation")); }));
}

TEST(EncoderEffects, AFaultyReferenceIsLockedToItsOwnAngle) {
  Scenario scenario = EncoderScenario();
  EncoderOf(scenario).encoder_procedure.mounting_rad = {0.0, 90.0 * deg};
  const auto fault = EncoderEffect("reference_fault", {{"order", 1.0}, {"amplitude", 0.01}});
  const auto readings = ReadingsWith(scenario, fault);
  for (int i = 0; i < 576; ++i) {
    const double shaft_rad = readings[i].measured_rad;
    EXPECT_NEAR(Error_rad(readings[i]), -0.01 * std::cos(shaft_rad), kTiny_rad);
    EXPECT_NEAR(Error_rad(readings[576 + i]), 90.0 * deg - 0.01 * std::cos(shaft_rad), kTiny_rad);
  }
}

// --- sine and cosine: angle of (x + f, y + g) is the phase plus (g cos - f sin) to first order ---

/// Largest deviation of the error from `expected(phase)`, with `periods` of the signals a turn.
template <class Expected>
double WorstMisfit_rad(const EffectSettings& effect, int periods, Expected expected) {
  Scenario scenario = EncoderScenario();
  EncoderOf(scenario).device.signal_periods = periods;
  EncoderOf(scenario).device.signal_zero_rad = 20.0 * deg;
  double worst_rad = 0.0;
  for (const Reading& r : ReadingsWith(scenario, effect)) {
    const double phase_rad = periods * (r.reference_rad - 20.0 * deg);
    worst_rad = std::max(worst_rad, std::abs(Error_rad(r) - expected(phase_rad) / periods));
  }
  return worst_rad;
}

TEST(EncoderEffects, SignalsErrByTheirOffsetsOncePerPeriodAndByMismatchAndQuadratureTwice) {
  const auto offset = EncoderEffect("signal_offset", {{"offset_sin", 1e-4}, {"offset_cos", 3e-4}});
  for (const int periods : {1, 10}) {
    EXPECT_LT(WorstMisfit_rad(offset, periods, [](double p) { return 1e-4 * std::cos(p) - 3e-4 * std::sin(p); }),
              1e-7);  // the square of the offsets
  }
  // (1 + r) sin against cos: r sin cos = r/2 sin 2p.
  const auto mismatch = EncoderEffect("amplitude_mismatch", {{"ratio", 1e-3}});
  EXPECT_LT(WorstMisfit_rad(mismatch, 1, [](double p) { return 0.5e-3 * std::sin(2.0 * p); }), 1e-6);
  // sin(p + q) = sin + q cos: q cos^2 = q/2 (1 + cos 2p).
  const auto quadrature = EncoderEffect("quadrature_error", {{"angle", 1e-3}});
  EXPECT_LT(WorstMisfit_rad(quadrature, 1, [](double p) { return 0.5e-3 * (1.0 + std::cos(2.0 * p)); }), 1e-6);
}

TEST(EncoderEffects, ClippingActsOnlyWhereASignalExceedsTheLevel) {
  const double level = 0.95;
  for (const Reading& r : ReadingsWith(EncoderScenario(), EncoderEffect("signal_clipping", {{"level", level}}))) {
    const double s = std::sin(r.reference_rad), c = std::cos(r.reference_rad);
    if (std::max(std::abs(s), std::abs(c)) < level) {
      EXPECT_NEAR(Error_rad(r), 0.0, kTiny_rad);
    } else if (s > level) {
      EXPECT_NEAR(c * std::sin(r.measured_rad), level * std::cos(r.measured_rad), kTiny_rad);  // atan2(level, c)
    }
  }
}

// --- motion ---

TEST(EncoderEffects, LatencyIsTheWayThatTheShaftWentMeanwhile) {
  for (const double delay_s : {0.002, -0.002}) {
    const auto readings = ReadingsWith(EncoderScenario("sweep"), EncoderEffect("latency", {{"delay", delay_s}}));
    for (std::size_t i = 2; i < readings.size(); ++i) {
      const double before_rad_s = readings[i - 1].velocity_rad_s,
                   gained_rad_s = readings[i].velocity_rad_s - before_rad_s;
      const double step_s = ToSeconds(readings[i].time - readings[i - 1].time);
      // Ramps are even: where they begin or end the acceleration is not known from the readings.
      if (std::abs(before_rad_s - readings[i - 2].velocity_rad_s - gained_rad_s) > 1e-9) continue;
      EXPECT_NEAR(Error_rad(readings[i]),
                  -delay_s * readings[i].velocity_rad_s + 0.5 * delay_s * delay_s * gained_rad_s / step_s,
                  kTiny_rad);
    }
  }
}

TEST(EncoderEffects, BacklashAtStopsIsHalfTheGapBehindTheMotion) {
  for (const double width : {0.02, -0.02}) {
    for (const Reading& r : ReadingsWith(EncoderScenario(), EncoderEffect("backlash", {{"width", width}})))
      EXPECT_NEAR(Error_rad(r), -0.5 * r.direction * width, kTiny_rad);
  }
}

TEST(EncoderEffects, BacklashInASweepIsCrossedOverItsWidthOfTravel) {
  const double width_rad = 2.0 * deg;
  Scenario scenario = EncoderScenario("sweep");
  EncoderOf(scenario).encoder_procedure.passes = {1, -1};
  const auto readings = ReadingsWith(scenario, EncoderEffect("backlash", {{"width", width_rad}}));
  double turned_at_rad = 0.0;
  for (const Reading& r : readings) {
    if (r.pass == 0) turned_at_rad = r.reference_rad;
    if (r.pass != 1) continue;
    const double way_rad = turned_at_rad - r.reference_rad;
    EXPECT_NEAR(Error_rad(r), std::min(way_rad, width_rad) - 0.5 * width_rad, kTiny_rad);
  }
}

TEST(EncoderEffects, BacklashBeginsWhereItIsSaidAndIsCrossedOverTheWayThatIsStated) {
  Scenario scenario = EncoderScenario("sweep");
  EncoderOf(scenario).encoder_procedure.passes = {1};
  const double width_rad = 1.0 * deg, way_rad = 40.0 * deg;
  const auto readings = ReadingsWith(
      scenario, EncoderEffect("backlash", {{"width", width_rad}, {"crossed_over", way_rad}, {"start", 0.5}}));
  for (const Reading& r : readings) {
    // From half way before the shaft to half the gap behind it.
    const double share = std::max(0.25 - r.reference_rad / way_rad, -0.5);
    EXPECT_NEAR(Error_rad(r), width_rad * share, kTiny_rad);
  }
}

TEST(EncoderEffects, HysteresisBeginsAsStatedAndSettlesExponentiallyWithTravelAfterAReversal) {
  Scenario scenario = EncoderScenario("sweep");
  EncoderOf(scenario).encoder_procedure.passes = {1, -1};
  const auto readings =
      ReadingsWith(scenario, EncoderEffect("hysteresis", {{"lag", 0.01}, {"settles_over", 20.0 * deg}}));
  double turned_at_rad = 0.0;
  for (const Reading& r : readings) {
    if (r.pass == 0) {
      turned_at_rad = r.reference_rad;
      EXPECT_NEAR(Error_rad(r), -0.01 * (1.0 - std::exp(-r.reference_rad / (20.0 * deg))), kTiny_rad);
    }
    if (r.pass != 1) continue;
    const double left = std::exp(-(turned_at_rad - r.reference_rad) / (20.0 * deg));
    EXPECT_NEAR(Error_rad(r), 0.01 * (1.0 - 2.0 * left), kTiny_rad);  // 37 settling ways forth: exp(-37) is left
  }
  const auto stated = EncoderEffect("hysteresis", {{"lag", 0.01}, {"settles_over", 20.0 * deg}, {"start", -1.0}});
  EXPECT_NEAR(Error_rad(ReadingsWith(scenario, stated).front()), 0.01, kTiny_rad);
}

TEST(EncoderEffects, ScaleGrowsWithTheTurnsDriftIsLinearWithAQuadraticShareAWarmUpSettlesAndASlipIsAStep) {
  using Expected = double (*)(const Reading& r, double time_s);
  const std::pair<EffectSettings, Expected> effects[] = {
      {EncoderEffect("scale", {{"ratio", 1e-4}}), [](const Reading& r, double) { return 1e-4 * r.reference_rad; }},
      {EncoderEffect("drift", {{"rate", 1e-6}, {"curvature", 0.5}}),
       [](const Reading&, double t) { return 1e-6 * t * (1.0 + 0.5 * (1.0 - t / 3600.0)); }},
      {EncoderEffect("drift", {{"rate", 1e-6}, {"warm_up", 600.0}}),
       [](const Reading&, double t) { return 600e-6 * (1.0 - std::exp(-t / 600.0)); }},
      {EncoderEffect("slip", {{"step", 0.01}, {"at_reading", 200.0}}),
       [](const Reading& r, double) { return r.reading < 200 ? 0.0 : 0.01; }}};
  for (const auto& [effect, expected] : effects) {
    for (const Reading& r : ReadingsWith(EncoderScenario(), effect))
      EXPECT_NEAR(Error_rad(r), expected(r, ToSeconds(r.time)), kTiny_rad) << effect.name;
  }
}

TEST(EncoderEffects, AZeroFollowsTheTemperatureOfTheRoomThatIsLogged) {
  constexpr double kRad_K = 1e-4, kK_h = 2.0, kLag_s = 600.0;
  Scenario scenario = EncoderScenario();
  scenario.environment.temperature_degC = 21.0;
  scenario.environment.drift_K_h = kK_h;
  // Behind a room that warms steadily a body stays behind by rate times lag, once exp(-t / lag) is over.
  const auto follower_K = [](double t_s, double lag_s) {
    const double per_s = kK_h / 3600.0;
    return 1.0 + per_s * (t_s - (lag_s > 0.0 ? lag_s * (1.0 - std::exp(-t_s / lag_s)) : 0.0));
  };
  for (const double lag_s : {0.0, kLag_s}) {
    const auto effect = EncoderEffect("zero_temperature", {{"coefficient", kRad_K}, {"lag", lag_s}});
    for (const Reading& r : ReadingsWith(scenario, effect)) {
      EXPECT_NEAR(r.temperature_degC, 21.0 + kK_h * ToSeconds(r.time) / 3600.0, 1e-9);
      EXPECT_NEAR(Error_rad(r), kRad_K * follower_K(ToSeconds(r.time), lag_s), kTiny_rad);
    }
  }
  EXPECT_TRUE(std::isnan(ReadingsWith(EncoderScenario(), EncoderEffect("scale")).front().temperature_degC))
      << "where the room does not change nobody looks";
}

TEST(EncoderEffects, SignalsThatBeginLaterErrLater) {
  const auto clipped = [](double zero_rad) {
    return ReadingsWith(EncoderScenario(), EncoderEffect("signal_clipping", {{"level", 0.5}, {"zero", zero_rad}}));
  };
  const auto here = clipped(0.0), later = clipped(5.0 * deg);  // the distance of two stops
  for (std::size_t i = 1; i < 144; ++i) EXPECT_NEAR(Error_rad(later[i]), Error_rad(here[i - 1]), kTiny_rad);
}

TEST(EncoderEffects, OutliersHitTheirShareOfTheReadings) {
  int hits = 0;
  const auto readings =
      ReadingsWith(EncoderScenario("sweep"), EncoderEffect("outliers", {{"fraction", 0.1}, {"size", 0.02}}));
  for (const Reading& r : readings) {
    const double size_rad = std::abs(Error_rad(r));
    if (size_rad < kTiny_rad) continue;
    ++hits;
    EXPECT_GE(size_rad, 0.5 * 0.02 - kTiny_rad);
    EXPECT_LE(size_rad, 1.5 * 0.02 + kTiny_rad);
  }
  // Binomial: deviation sqrt(0.1 * 0.9 / 4320) = 0.0046; three of these.
  EXPECT_NEAR(hits / static_cast<double>(readings.size()), 0.1, 0.014);
}

}  // namespace
}  // namespace twinbench
