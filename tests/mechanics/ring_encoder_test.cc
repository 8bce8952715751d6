#include "mechanics/ring_encoder.h"

#include "mechanics/encoder_signal.h"
#include "tests/mechanics/plant_runs.h"

namespace twinbench::mechanics {
namespace {

constexpr double kRadius_m = 0.05;
constexpr double kRounding_rad = 1e-14;  // some operations on angles of a few turns in double

Ring GoodRing() { return {.radius_m = kRadius_m, .lines = 18000}; }

/// All errors at once, some hundred times what a real ring has.
Ring BadRing() {
  Ring ring = GoodRing();
  ring.eccentricity_m = {120e-6, -70e-6};
  ring.tilt_rad = {3e-3, -2e-3};
  ring.mounting_rad = 0.4;
  ring.ellipticity_m = 90e-6;
  ring.ellipticity_azimuth_rad = 0.7;
  ring.graduation = {{1.0, 2e-4, 0.2}, {7.0, 5e-5, -1.0}};
  return ring;
}

double Error_rad(const RingEncoder& encoder, double shaft_rad, const Eigen::Vector2d& radial_m = {0.0, 0.0}) {
  return encoder.Scale_rad(shaft_rad, radial_m) - (shaft_rad - encoder.MarkAtShaft_rad());
}

/// C of Re C exp(j order th), from 64 angles of a turn; leakage of orders that are missing there is rounding.
std::complex<double> Coefficient(int order, const std::function<double(double)>& error_rad) {
  constexpr int kAngles = 64;
  std::complex<double> sum = 0.0;
  for (int i = 0; i < kAngles; ++i) {
    const double th = 2.0 * kPi * i / kAngles;
    sum += error_rad(th) * std::polar(2.0 / kAngles, -order * th);
  }
  return sum;
}

std::complex<double> Coefficient(int order, const RingEncoder& encoder) {
  return Coefficient(order, [&](double th) { return Error_rad(encoder, th); });
}

TEST(RingEncoder, EccentricityFollowsTheSineTheorem) {
  Ring ring = GoodRing();
  const double a = 0.08, phi = 0.9;  // 4 mm: an exact formula needs no small error
  ring.eccentricity_m = a * kRadius_m * Eigen::Vector2d(std::cos(phi), std::sin(phi));
  const RingEncoder encoder(ring, {0.5, 0.0, 0.0});
  for (double th = 0.0; th < 13.0; th += 0.37)
    EXPECT_NEAR(Error_rad(encoder, th), std::asin(a * std::sin(th + phi - 0.5)), kRounding_rad) << th;
}

TEST(RingEncoder, ATiltMovesTheRingUnderAHeadThatIsHigher) {
  Ring ring = GoodRing();
  const double tilt = 1e-4, height_m = 0.01;
  ring.tilt_rad = {0.0, tilt};
  const RingEncoder encoder(ring, {0.0, height_m, 0.0});
  // Tilted about y, the ring's axis stands off by height x tilt along x: sin(th), phase -90 degrees.
  const std::complex<double> expected = std::polar(height_m * tilt / kRadius_m, -0.5 * kPi);
  EXPECT_LT(std::abs(Coefficient(1, encoder) - expected), 1e-7 * std::abs(expected));  // next: tilt^2
}

TEST(RingEncoder, ATiltForeshortensTheRingAtOrderTwo) {
  Ring ring = GoodRing();
  const double tilt = 0.05;
  ring.tilt_rad = {tilt, 0.0};
  const RingEncoder encoder(ring, {});
  // About x: what is cos b, sin b in the horizontal plane is cos b, sin b cos(tilt) across the ring's axis.
  for (double th = -1.5; th < 1.5; th += 0.21)
    EXPECT_NEAR(encoder.Scale_rad(th), std::atan(std::tan(th) * std::cos(tilt)), kRounding_rad) << th;
  // tan^2(tilt / 2) of that is order 2: tilt^2 / 4 to a share of tilt^2 / 6
  EXPECT_NEAR(std::abs(Coefficient(2, encoder)), tilt * tilt / 4.0, tilt * tilt / 4.0 * tilt * tilt / 4.0);
  EXPECT_LT(std::abs(Coefficient(1, encoder)), kRounding_rad);
}

TEST(RingEncoder, ABentRingMovesItsLinesByHalfOfWhatItsRadiusGains) {
  Ring ring = GoodRing();
  ring.ellipticity_m = 2e-6;
  ring.ellipticity_azimuth_rad = 0.6;
  const RingEncoder encoder(ring, {});
  // A ring that keeps its length has its lines closer in angle where it is wider: the scale counts faster while its
  // long axis, at shaft angle -azimuth, passes the head. Their products with u / R are left out.
  const double amplitude = 0.5 * 2e-6 / kRadius_m;
  for (double th = 0.0; th < 6.3; th += 0.7)
    EXPECT_NEAR(Error_rad(encoder, th), amplitude * std::sin(2.0 * (th + 0.6)), 3.0 * amplitude * amplitude);
}

TEST(RingEncoder, AnEllipsesAxesHaveItsRadii) {
  Ring ring = GoodRing();
  ring.ellipticity_m = 0.4e-3;
  ring.ellipticity_azimuth_rad = 0.6;
  const double sideways_m = 0.02;
  const RingEncoder encoder(ring, {0.0, 0.0, sideways_m});
  // The head looks at the end of the long axis, then of the short one: lines there are where they belong.
  for (const auto& [angle, radius_m] : {std::pair(0.6, kRadius_m + 0.4e-3), {0.6 + 0.5 * kPi, kRadius_m - 0.4e-3}})
    EXPECT_NEAR(encoder.Scale_rad(std::asin(sideways_m / radius_m) - angle), -angle, kRounding_rad);
}

TEST(RingEncoder, ShaftThatMovesAlongTheHeadIsReadAsATurnAndAHeadOffItsPlaceReadsTheLineThere) {
  const double azimuth = 0.8, d_m = 2e-6;
  const RingEncoder encoder(GoodRing(), {azimuth, 0.0, 0.0}), aside(GoodRing(), {0.0, 0.0, 0.002});
  const Eigen::Vector2d along(-std::sin(azimuth), std::cos(azimuth)), towards(std::cos(azimuth), std::sin(azimuth));
  for (const double th : {0.0, 1.0, 4.0}) {  // in the fixed frame: whatever the angle
    EXPECT_NEAR(Error_rad(encoder, th, d_m * along), std::asin(d_m / kRadius_m), kRounding_rad);
    EXPECT_NEAR(Error_rad(encoder, th, d_m * towards), 0.0, kRounding_rad);
    // The sideways head is further on, where lines come earlier that count up later.
    EXPECT_NEAR(Error_rad(aside, th), -std::asin(0.002 / kRadius_m), kRounding_rad);
  }
}

TEST(RingEncoder, GraduationIsAnErrorInTheScalesOwnAngle) {
  Ring ring = GoodRing();
  ring.mounting_rad = 0.9;
  ring.graduation = {{3.0, 5.0 * kArcsec, 0.4}};
  const RingEncoder encoder(ring, {2.0, 0.0, 0.0});
  for (double th = 0.0; th < 6.0; th += 0.5)
    EXPECT_NEAR(Error_rad(encoder, th), 5.0 * kArcsec * std::cos(3.0 * (th - 1.1) + 0.4), kRounding_rad);
}

TEST(RingEncoder, StaysContinuousOverManyTurns) {
  const RingEncoder encoder(BadRing(), {0.3, 0.004, 1e-4});
  for (double th = -40.0; th < 40.0; th += 0.01) {
    const double gain = (encoder.Scale_rad(th + 0.01) - encoder.Scale_rad(th)) / 0.01;
    ASSERT_NEAR(gain, 1.0, 0.01) << th;  // errors' slopes: 2e-3 each
  }
}

TEST(RingEncoder, FindsTheShaftThatShowsAnAngle) {
  const RingEncoder encoder(BadRing(), {0.3, 0.004, 1e-4});
  const Eigen::Vector2d radial_m(3e-6, -5e-6);
  for (double th = -30.0; th < 30.0; th += 0.77)
    EXPECT_NEAR(encoder.Shaft_rad(encoder.Scale_rad(th, radial_m), radial_m), th, kRounding_rad);
}

TEST(RingEncoder, RefusesWhatIsNoRing) {
  using R = Ring;
  using H = ReadingHead;
  using Change = void (*)(R&, H&);
  const Change changes[] = {
      [](R& r, H&) { r = {}; }, [](R& r, H&) { r.radius_m = 0.0; }, [](R& r, H&) { r.lines = 0; },
      [](R& r, H&) { r.eccentricity_m.x() = 0.006; }, [](R& r, H&) { r.eccentricity_m.y() = std::nan(""); },
      [](R& r, H&) { r.tilt_rad.x() = 0.2; }, [](R& r, H&) { r.ellipticity_m = -0.001; },
      [](R& r, H&) { r.mounting_rad = std::nan(""); }, [](R& r, H&) { r.ellipticity_azimuth_rad = std::nan(""); },
      [](R& r, H&) { r.graduation = {{1.0, std::nan(""), 0.0}}; },
      [](R& r, H&) { r.graduation = {{18000.0, 1e-4, 0.0}}; },
      [](R&, H& h) { h.azimuth_rad = std::nan(""); }, [](R&, H& h) { h.height_m = std::nan(""); },
      [](R&, H& h) { h.tangential_m = 0.03; }, [](R& r, H& h) { r.tilt_rad.x() = 0.05, h.height_m = 0.2; }};
  for (const Change change : changes) {
    Ring ring = GoodRing();
    ReadingHead head;
    change(ring, head);
    EXPECT_THROW(RingEncoder(ring, head), std::invalid_argument);
  }
}

SignalState Faults() { return {.offset_sin = 0.1, .offset_cos = -0.15, .ratio = 0.2, .quadrature_rad = 0.3}; }

TEST(EncoderSignal, FindsThePhaseThatShowsAnAngle) {
  for (const double clip : {HUGE_VAL, 1.0, 0.8}) {
    SignalState state = Faults();
    state.clip_level = clip;
    for (double p = -20.0; p < 20.0; p += 0.317) {
      const double shown = p + SignalError_rad(state, p);
      const double found = PhaseShowing_rad(state, shown);
      // Where both are clipped many phases show the same; elsewhere slopes reach 3, and phases 20.
      EXPECT_NEAR(found + SignalError_rad(state, found), shown, 1e-13) << p << " clipped at " << clip;
      if (clip == HUGE_VAL) {
        EXPECT_NEAR(found, p, 1e-13);
      }
    }
  }
}

TEST(InterpolatedSignal, OfGoodSignalsCutsALineIntoEqualSteps) {
  const InterpolatedSignal signal({}, 1000, 20);
  EXPECT_DOUBLE_EQ(signal.Step_rad(), 2.0 * kPi / 20000.0);
  for (const int step : {-20001, -1, 0, 7, 20000, 123456}) {
    EXPECT_EQ(signal.Steps((step + 0.01) * signal.Step_rad()), step);
    EXPECT_EQ(signal.Steps((step + 0.99) * signal.Step_rad()), step);
    EXPECT_NEAR(signal.FallingEdge_rad(step, 1), (step + 0.5) * signal.Step_rad(), 1e-14);
    EXPECT_NEAR(signal.FallingEdge_rad(step, -1), step * signal.Step_rad(), 1e-14);
  }
}

TEST(InterpolatedSignal, FallsWhereHighGivesWayToLowInEitherDirection) {
  const InterpolatedSignal signal(Faults(), 500, 8);
  // High in the first half of a step, by what the signals show.
  const auto high = [&](double scale) {
    const double steps = signal.Shown_rad(scale) / signal.Step_rad();
    return steps - std::floor(steps) < 0.5;
  };
  const double little = 1e-9 * signal.Step_rad();
  for (int step = -40; step < 40; ++step) {
    for (const int way : {1, -1}) {
      const double edge = signal.FallingEdge_rad(step, way);
      EXPECT_TRUE(high(edge - way * little)) << step;
      EXPECT_FALSE(high(edge + way * little)) << step;
    }
  }
}

TEST(InterpolatedSignal, EdgesOfWholeLinesAreRegularWhateverTheFaults) {
  const InterpolatedSignal signal(Faults(), 500, 1);
  const double first = signal.FallingEdge_rad(0, 1);
  EXPECT_GT(std::abs(first - 0.5 * signal.Step_rad()), 1e-4 * signal.Step_rad());
  // The faults repeat with the lines: an output of one period a line has them in its zero only.
  for (int step = 1; step < 2000; step += 37)
    EXPECT_NEAR(signal.FallingEdge_rad(step, 1) - first, step * signal.Step_rad(), 1e-13) << step;
}

TEST(InterpolatedSignal, NextEdgeLiesAheadAndNoneIsLeftOut) {
  const InterpolatedSignal signal(Faults(), 500, 8);
  for (const int way : {1, -1}) {
    double scale = -0.02;
    std::int64_t step = signal.NextFallingStep(scale, way);
    for (int i = 0; i < 100; ++i) {
      const double edge = signal.FallingEdge_rad(step, way);
      EXPECT_GT(way * (edge - scale), 0.0);
      EXPECT_LE(way * (signal.FallingEdge_rad(step - way, way) - scale), 0.0);
      scale = edge;  // exactly on an edge: the next one
      EXPECT_EQ(signal.NextFallingStep(scale, way), step + way);
      step += way;
    }
  }
}

TEST(InterpolatedSignal, RefusesSignalsThatDoNotGoRoundTheOrigin) {
  for (const SignalState& state : {SignalState{.ratio = -1.0}, SignalState{.quadrature_rad = 1.6},
                                   SignalState{.offset_sin = 0.8}, SignalState{.offset_cos = std::nan("")},
                                   SignalState{.clip_level = 0.0}})
    EXPECT_THROW(InterpolatedSignal(state, 100, 1), std::invalid_argument);
  EXPECT_THROW(InterpolatedSignal({}, 0, 1), std::invalid_argument);
  EXPECT_THROW(InterpolatedSignal({}, 100, 0), std::invalid_argument);
}

}  // namespace
}  // namespace twinbench::mechanics
