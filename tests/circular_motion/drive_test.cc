#include "tests/circular_motion/written_circles.h"
#include "tests/support/thresholds.h"
#include "twin/benches/circular_motion/bench.h"
#include "twin/benches/circular_motion/twin/live.h"
#include "twin/benches/evaluated.h"
#include "twin/core/stream.h"

// What a controller logs of its own axes on a circle, and a grid plate. Readings are written here from how late
// each axis is, and from what each error does to the path.
namespace twinbench::benches::circular {
namespace {

using test::ExpectCircleError;
using units::arcsec, units::deg, units::mm, units::um;

constexpr double kCircle_m = 50.0 * mm;

struct Drives {
  bool are_delayed = true;  // by a fixed time, else of first order
  double late_x_s = 5e-3, late_y_s = 6e-3, scale_x = 20e-6, scale_y = -10e-6, squareness_rad = 30e-6;
};

/// Where an axis is that was sent along R cos(phase).
double Along_m(const Drives& d, double phase_rad, double rate_rad_s, double late_s) {
  const double lag = rate_rad_s * late_s;
  return d.are_delayed ? kCircle_m * std::cos(phase_rad - lag)
                       : kCircle_m / std::hypot(1.0, lag) * std::cos(phase_rad - std::atan(lag));
}

/// Once round each way at every feed.
std::vector<Reading> Logged(const Drives& d, const std::vector<double>& feeds_mm_min,
                            const std::vector<int>& directions = {1, -1}) {
  Stream noise(4, "drive");
  std::vector<Reading> readings;
  for (const double feed_mm_min : feeds_mm_min) {
    const test::WrittenCircles circles{kCircle_m, feed_mm_min * mm / 60.0, 720, 0.3, 0.0, 360.0, directions};
    const auto show = [&](Reading& r, double a) {
      const double rate_rad_s = r.direction * circles.feed_m_s / kCircle_m;
      const double x_m = Along_m(d, a, rate_rad_s, d.late_x_s);
      const double y_m = Along_m(d, a - 0.5 * units::kPi, rate_rad_s, d.late_y_s);
      kGridX_m(r) = x_m * (1.0 + d.scale_x) - d.squareness_rad * y_m + 0.1 * um * noise.Normal();
      kGridY_m(r) = y_m * (1.0 + d.scale_y) + 0.1 * um * noise.Normal();
    };
    readings = Written(circles, show, std::move(readings));
  }
  return readings;
}

nlohmann::json ResultsOf(const std::vector<Reading>& readings) {
  return EvaluationOf(test::ToldOfCircles("drive", kCircle_m), readings, Estimator::kRigorous).results;
}

TEST(Drive, IsLateByAFixedTimeOrByFirstOrderAsTwoFeedsSay) {
  for (const bool are_delayed : {true, false}) {
    const nlohmann::json results = ResultsOf(Logged({.are_delayed = are_delayed}, {1000.0, 3000.0}));
    EXPECT_EQ(results.at("lag_kind"), are_delayed ? "fixed_delay" : "first_order");
    EXPECT_EQ(results.at("setups")[0].at("instrument"), "drive");
    ExpectCircleError(results, "machine.scale_x_um_m", 20.0, 1.0);
    ExpectCircleError(results, "machine.scale_y_um_m", -10.0, 1.0);
    ExpectCircleError(results, "machine.lag_x_s", 5e-3, 1e-5);
    ExpectCircleError(results, "machine.lag_y_s", 6e-3, 1e-5);
    ExpectCircleError(results, "machine.squareness_arcsec", 30e-6 / arcsec, 1.5);
  }
}

/// Circles of a file in machine coordinates are about their own centres; arcs too, and what stands about the origin is left.
TEST(Drive, IsAboutTheCentreOfWhatWasCommanded) {
  std::vector<Reading> readings = Logged({}, {1000.0});
  readings.erase(readings.begin() + 900, readings.end());
  const std::vector<Reading> about_origin = readings;
  AboutItsCentre(readings);
  EXPECT_EQ(kCommandedX_m(readings[7]), kCommandedX_m(about_origin[7]));
  for (Reading& r : readings) {
    kCommandedX_m(r) += 250.0 * mm, kGridX_m(r) += 250.0 * mm;
    kCommandedY_m(r) -= 120.0 * mm, kGridY_m(r) -= 120.0 * mm;
  }
  AboutItsCentre(readings);
  for (std::size_t k = 0; k < readings.size(); ++k) {
    ASSERT_NEAR(kCommandedX_m(readings[k]), kCommandedX_m(about_origin[k]), 1e-9);
    ASSERT_NEAR(kGridY_m(readings[k]), kGridY_m(about_origin[k]), 1e-9);
  }
}

TEST(Drive, SaysWhereRowsGoTheOtherWayRoundThanTheySay) {
  std::vector<Reading> readings = Logged({}, {1000.0, 3000.0});
  for (Reading& r : readings)
    if (r.pass == 1) r.direction = -r.direction;
  EXPECT_THAT(ResultsOf(readings).at("not_described").get<std::string>(),
              testing::HasSubstr("places go the other way round than the rows say: mounting 0, pass 1)"));
}

/// Of a circle a second of angle a lag of 5 ms takes 12.5 um/m, or nothing.
TEST(Drive, IsAmbiguousAtOneFeed) {
  const nlohmann::json results = ResultsOf(Logged({}, {3000.0}));
  EXPECT_EQ(results.at("lag_kind"), "ambiguous");
  EXPECT_EQ(results.at("ranked")[0].at("error"), "servo mismatch (x less y)")
      << "1 ms at 50 mm/s makes an ellipse of 50 um";
  EXPECT_NEAR(results.at("ranked")[0].at("share_um").get<double>(), 50.0, 0.5);
  EXPECT_FALSE(results.at("errors").contains("machine.scale_x_um_m"));
  ExpectCircleError(results, "machine.lag_x_s", 5e-3, 1e-5);
  ExpectCircleError(results, "machine.squareness_arcsec", 30e-6 / arcsec, 1.5);
}

/// A grid plate that is turned looks as axes do that are late alike; a controller's axes are not turned.
TEST(Drive, ShowsItsLagOneWayRound) {
  ExpectCircleError(ResultsOf(Logged({}, {1000.0, 3000.0}, {1})), "machine.lag_x_s", 5e-3, 1e-5);
}

/// A lag that makes the circle smaller was taken for a turned plate, and what is left of it for scales of both axes.
TEST(Drive, IsDiagnosedWithItsLagOneWayRound) {
  const Drives late{.are_delayed = false, .late_x_s = 12e-3, .late_y_s = 12.5e-3, .scale_x = 0.0, .scale_y = 0.0, .squareness_rad = 0.0};
  const diagnose::Diagnosis found = Diagnose(Logged(late, {3000.0}, {-1}), test::ToldOfCircles("drive", kCircle_m), {}).diagnosis;
  EXPECT_EQ(std::ranges::count(found.causes, "servo_lag", &diagnose::Cause::effect), 1);
  EXPECT_EQ(std::ranges::count(found.causes, "scale", &diagnose::Cause::effect), 0);
}

TEST(Drive, IsLateByAFixedTimeWhereTheScenarioSaysSo) {
  const sim::CircleRun run(
      test::ToldOfCircles("drive", kCircle_m,
                          {"noise_free=true", "circular_procedure.feeds_mm_min=[3000]", "machine.lag_x_s=0.005",
                           "machine.lag_y_s=0.006", "machine.lag_kind=fixed_delay"}));
  const Reading r = run.Take(7);
  const double at_rad = std::atan2(kCommandedY_m(r), kCommandedX_m(r));  // and a radian a second
  EXPECT_NEAR(kGridX_m(r) / mm, 50.0 * std::cos(at_rad - 0.005), 1e-9);
  EXPECT_NEAR(kGridY_m(r) / mm, 50.0 * std::sin(at_rad - 0.006), 1e-9);
}

TEST(Drive, HasNoKindOfLagWhereNoneIsSeen) {
  EXPECT_FALSE(ResultsOf(Logged({.late_x_s = 0.0, .late_y_s = 0.0}, {1000.0, 3000.0})).contains("lag_kind"));
}

constexpr double kGridCircle_m = 80.0 * mm;

/// Squareness turns Y towards -X.
struct Plane {
  double squareness_rad, scale_x, scale_y, backlash_x_m, backlash_y_m;
};

/// @param show  What else is done to a reading.
template <class Show>
diagnose::Diagnosis DiagnosisOfGrid(const Plane& plane, double feed_m_s, Show show) {
  Stream stream(7, "grid");
  const auto readings = test::Written({kGridCircle_m, feed_m_s, 360, 0.0, 5.7}, [&](Reading& r, double a) {
    const double x_m = kCommandedX_m(r), y_m = kCommandedY_m(r);
    kGridX_m(r) = x_m * (1.0 + plane.scale_x) - plane.squareness_rad * y_m +
                  test::Behind_m(kGridCircle_m, plane.backlash_x_m, a, r.direction) + 0.05 * um * stream.Normal();
    kGridY_m(r) = y_m * (1.0 + plane.scale_y) +
                  test::Behind_m(kGridCircle_m, plane.backlash_y_m, a - 90.0 * deg, r.direction) +
                  0.05 * um * stream.Normal();
    show(r, a);
  });
  const Scenario scenario =
      test::ToldOfCircles("grid", kGridCircle_m, {"machine.lag_x_s=0", "machine.lag_y_s=0", "machine.span_mm=80"});
  return Diagnose(readings, scenario, test::QuickOptions(100)).diagnosis;
}

const diagnose::Cause* CauseOf(const diagnose::Diagnosis& d, const std::string& effect, const std::string& where) {
  for (const diagnose::Cause& cause : d.causes)
    if (cause.effect == effect && cause.where == where) return &cause;
  return nullptr;
}

TEST(GridPlate, HasItsSquarenessScalesAndBacklashesNamedTogether) {
  const Plane plane{12.0 * arcsec, 20e-6, -25e-6, 4.0 * um, 6.0 * um};
  const diagnose::Diagnosis d = DiagnosisOfGrid(plane, 1000.0 * mm / 60.0, [](Reading&, double) {});
  for (const auto& [effect, where, size] : {std::tuple{"squareness", "", plane.squareness_rad},
                                            {"scale", "x", plane.scale_x},
                                            {"scale", "y", plane.scale_y},
                                            {"backlash", "x", plane.backlash_x_m},
                                            {"backlash", "y", plane.backlash_y_m}}) {
    const diagnose::Cause* const cause = CauseOf(d, effect, where);
    ASSERT_TRUE(cause) << effect << " " << where;
    EXPECT_NEAR(cause->parameters[0].value, size, 4.0 * cause->parameters[0].u) << effect << " " << where;
  }
  EXPECT_FALSE(CauseOf(d, "outliers", "")) << "a reading on the way through a reversal is no outlier";
  EXPECT_FALSE(HasUnmodelled(d));
}

TEST(GridPlate, HasTheScaleOfAnAxisBesideLagsThatAreNotAlike) {
  // Of first order: along each axis 1 / (1 + lag s) at the circle's rate.
  constexpr double kLagX_s = 3.0e-3, kLagY_s = 3.6e-3, kScaleX = 20e-6, kFeed = 15.0 * units::mm * 1000.0 / 60.0;
  const diagnose::Diagnosis d = DiagnosisOfGrid({}, kFeed, [&](Reading& r, double a) {
    const auto lagging_m = [&](double from_rad, double lag_s) {
      const double lag_rad = r.direction * kFeed / kGridCircle_m * lag_s;
      return kGridCircle_m / std::hypot(1.0, lag_rad) * std::cos(from_rad - std::atan(lag_rad));
    };
    kGridX_m(r) += (1.0 + kScaleX) * lagging_m(a, kLagX_s) - kCommandedX_m(r);
    kGridY_m(r) += lagging_m(a - 90.0 * deg, kLagY_s) - kCommandedY_m(r);
  });
  const diagnose::Cause* const scale = CauseOf(d, "scale", "x");
  ASSERT_TRUE(scale);
  EXPECT_NEAR(scale->parameters[0].value, kScaleX, 4.0 * scale->parameters[0].u);
  EXPECT_FALSE(HasUnmodelled(d));
}

}  // namespace
}  // namespace twinbench::benches::circular
