#include "tests/circular_motion/written_circles.h"
#include "twin/benches/circular_motion/bench.h"
#include "twin/benches/circular_motion/estimators/far_radii.h"
#include "twin/benches/evaluated.h"
#include "twin/core/stream.h"
#include "twin/core/units.h"

// One reading that is far off is no form of a circle, and what every turn shows is none that is far off.
namespace twinbench::benches::circular {
namespace {

using namespace separate::circular;
using separate::FarOnCourse;
using units::deg, units::mm, units::um;

constexpr double kFarCircle_m = 120.0 * mm;

/// A degree apart, 2.5 um cos 4a and more, with a noise of 0.1 um.
template <class More_m>
std::vector<Reading> TurnsEachWay(int turns, const More_m& more_m) {
  Stream noise(11, "bar");
  return WithAngles(test::Written({kFarCircle_m, 0.02, 360, 0.4, 0.0, 360.0 * turns}, [&](Reading& r, double a) {
    kBar_m(r) = 2.5 * um * std::cos(4.0 * a) + 0.1 * um * noise.Normal() + more_m(r.position, r.direction);
  }));
}

TEST(FarRadii, ASingleOneIsTakenOutWithItsPlace) {
  std::vector<Reading> readings = TurnsEachWay(1, [](int k, int way) { return k == 217 && way < 0 ? -40.0 * um : 0.0; });
  const std::vector<FarOnCourse> far = TakeOutFar(readings);
  ASSERT_EQ(far.size(), 1U);
  EXPECT_EQ(far[0].reading, 360 + 217);
  EXPECT_NEAR(std::remainder(far[0].angle_rad / deg + 217.4, 360.0), 0.0, 1e-6);
  EXPECT_NEAR(far[0].off / um, -40.0, 0.8);  // five of its noise with that of its neighbours, 0.14 um
  EXPECT_EQ(readings.size(), 719U);
}

TEST(FarRadii, WhatEveryTurnShowsAStepAndWhatFollowsAReversalStay) {
  std::vector<Reading> each = TurnsEachWay(2, [](int k, int) { return k % 360 == 130 ? 15.0 * um : 0.0; });
  EXPECT_TRUE(TakeOutFar(each).empty());
  std::vector<Reading> step = TurnsEachWay(1, [](int k, int way) { return k > 200 && way > 0 ? 15.0 * um : 0.0; });
  EXPECT_TRUE(TakeOutFar(step).empty());
  std::vector<Reading> reversal = TurnsEachWay(1, [](int k, int) { return k == 91 ? 15.0 * um : 0.0; });
  EXPECT_TRUE(TakeOutFar(reversal).empty());
}

TEST(FarRadii, ACircularDeviationIsWithoutThem) {
  const std::vector<Reading> readings = TurnsEachWay(1, [](int k, int way) { return k == 300 && way > 0 ? 60.0 * um : 0.0; });
  const Scenario scenario = test::ToldOfCircles("radial_bar", kFarCircle_m);
  const nlohmann::json results = EvaluationOf(scenario, readings, Estimator::kRigorous).results;
  // 5 um, and by two extremes of about 60 readings each of the noise: 4.6 x 0.1 um.
  EXPECT_NEAR(results.at("iso230_4").at(0).at("G_ccw_um").get<double>(), 5.3, 0.4);
  EXPECT_EQ(results.at("far").at(0).at("reading"), 300);
  EXPECT_EQ(results.at("left_out"), 1);
}

TEST(CircleLogs, OfManyReadingsAreDiagnosedByAPartWithAllReversals) {
  constexpr int kRows = 9000;
  const std::vector<Reading> readings =
      test::Written({kFarCircle_m, 0.05, kRows / 3, 0.5, 0.0, 1080.0}, [](Reading& r, double) {
        kGridX_m(r) = kCommandedX_m(r);
        kGridY_m(r) = kCommandedY_m(r);
      });
  const diagnose::LinearRun run =
      Linear(readings, test::ToldOfCircles("drive", kFarCircle_m), Estimator::kRigorous);
  EXPECT_LT(run.schedule.Readings(), 2200);
  for (int quarter = 1; quarter < 12; ++quarter)  // an axis turns round at each
    for (int k = quarter * kRows / 12 - 5; k < quarter * kRows / 12 + 5; ++k) EXPECT_EQ(std::ranges::count(run.schedule.reading, k), 1) << k;
}

// The pitch of a screw and the time after which a spike is largest are the machine's, whatever a scenario states.

constexpr double kShaped_m = 90.0 * mm, kShapedFeed_m_s = 1200.0 * mm / 60.0;

struct ShapedErrors {
  double squareness_rad = 5.0 * units::arcsec, cyclic_y_m = 0.0, pitch_m = 6.0 * mm, spike_x_m = 0.0,
         spike_time_s = 0.15, lobes_m = 0.0;
};

/// A radius each quarter of a degree.
nlohmann::json ResultsOfShaped(const ShapedErrors& e) {
  Stream noise(23, "bar");
  const auto show = [&](Reading& r, double a) {
    const double x_m = kCommandedX_m(r), y_m = kCommandedY_m(r),
                 turned_rad = units::turn * (r.position + 0.5) / 1440;
    // X turns round at 0 and at 180 deg, and goes down behind the former.
    const double along_rad = std::fmod(turned_rad, units::kPi), sense = turned_rad < units::kPi ? -1.0 : 1.0;
    const double times = along_rad * kShaped_m / kShapedFeed_m_s / e.spike_time_s;
    const double dx_m = -e.squareness_rad * y_m - sense * e.spike_x_m * times * std::exp(1.0 - times);
    const double dy_m = e.cyclic_y_m * std::sin(units::turn * y_m / e.pitch_m + 0.8);
    kBar_m(r) = std::hypot(x_m + dx_m, y_m + dy_m) - kShaped_m + e.lobes_m * std::cos(7.0 * a) +
                0.08 * um * noise.Normal();
  };
  const std::vector<Reading> readings = test::Written({kShaped_m, kShapedFeed_m_s, 1440}, show);
  return EvaluationOf(test::ToldOfCircles("radial_bar", kShaped_m), readings, Estimator::kRigorous).results;
}

TEST(FoundShapes, ArePitchAndTimeOfTheMachine) {
  const nlohmann::json results = ResultsOfShaped({.cyclic_y_m = 1.2 * um, .spike_x_m = 3.0 * um});
  EXPECT_NEAR(results.at("as_read").at("cyclic_pitch_mm").get<double>(), 6.0, 0.01);
  EXPECT_NEAR(results.at("as_read").at("spike_time_s").get<double>(), 0.15, 0.01);
  for (const auto& [name, value] : {std::pair{"cyclic_y_um", 1.2}, {"spike_x_um", 3.0}, {"backlash_x_um", 0.0},
                                    {"backlash_y_um", 0.0}, {"squareness_arcsec", 5.0}})
    test::ExpectCircleError(results, std::string("machine.") + name, value, 0.2);
}

TEST(FoundShapes, AreAsStatedWhereTheyAreSoOrNoneDescribesWhatIsLeft) {
  EXPECT_FALSE(ResultsOfShaped({.cyclic_y_m = 1.2 * um, .pitch_m = 10.0 * mm}).contains("as_read"));
  EXPECT_FALSE(ResultsOfShaped({.lobes_m = 3.0 * um}).contains("as_read"));
}

// What noise and steps of readings make of the circular deviations, against those of the path itself.

struct Kind {
  double order, noise_um, step_um;
  int readings = 360;
};

/// 3 um cos(order a) about a centre that is some um off, as a bar of this noise and step shows it. Noise is stated as
/// 0.25 um.
CirclePath Shown(const Kind& kind, Stream& stream) {
  const double phase_rad = units::turn * stream.Uniform();
  const Eigen::Vector2d centre_m(7.0 * um * stream.Normal(), 7.0 * um * stream.Normal());
  const auto show = [&](PathPoint& point, const Eigen::Vector2d& outwards) {
    const double lobes_m = kind.order > 0.0 ? 3.0 * um * std::cos(kind.order * point.commanded_rad + phase_rad) : 0.0;
    point.shown_m = centre_m.dot(outwards) + lobes_m + kind.noise_um * um * stream.Normal();
    if (kind.step_um > 0.0) point.shown_m = kind.step_um * um * std::round(point.shown_m / (kind.step_um * um));
    point.d_m = (point.shown_m - centre_m.dot(outwards)) * outwards;
    point.u_own_m = Eigen::Vector2d::Constant(0.25 * um);
  };
  return test::WrittenPath(1, 150.0 * mm, kind.readings, 0.3 * units::turn / kind.readings, show);
}

/// One unknown that is known as good as exactly.
SharedUncertainty NearlyNothing() { return test::SharedLength(1e-6 * um); }

TEST(CircularDeviationNoise, IsInTheUncertaintyWithWhatItMakesExtremesLargerBy) {
  constexpr int kTrials = 20;
  Stream stream(7, "bar");
  int within = 0, all = 0;
  for (const double order : {0.0, 2.0, 5.0}) {
    for (const auto& [noise_um, step_um] : {std::pair{0.0, 0.1}, {0.0, 1.0}, {0.05, 0.0}, {0.1, 1.0}, {0.5, 0.1}, {2.0, 0.0}}) {
      for (int k = 0; k < kTrials; ++k) {
        const Iso230_4 d = CircularDeviations({Shown({order, noise_um, step_um}, stream)}, NearlyNothing())[0];
        const double size_m = order > 0.0 ? 3.0 * um : 0.0;
        for (const auto& [value, of_path_m] : {std::pair{d.G_ccw, 2.0 * size_m}, {d.G_mz_ccw, 2.0 * size_m}, {d.Fmax_ccw, size_m}, {d.Fmin_ccw, -size_m}}) {
          ++all;
          within += std::abs(value.value_m - of_path_m) < 2.0 * value.u_m ? 1 : 0;
        }
      }
    }
  }
  EXPECT_GT(within, 0.93 * all);
}

TEST(CircularDeviationNoise, IsThatOfTheReadingsAndNotTheOneThatIsStated) {
  Stream stream(8, "bar");
  const auto u_um = [&](const Kind& kind) {
    return CircularDeviations({Shown(kind, stream)}, NearlyNothing())[0].G_ccw.u_m / um;
  };
  // Of pure noise, the largest of n normal deviates at either end: 2.9 deviations for 360, of which some 2.4 are told.
  EXPECT_NEAR(u_um({0.0, 0.02, 0.0}), 0.1, 0.025);
  EXPECT_NEAR(u_um({0.0, 2.0, 0.0}), 10.0, 2.5);
  EXPECT_GT(u_um({0.0, 1.0, 0.0, 3600}), u_um({0.0, 1.0, 0.0, 90}) + 0.5) << "among more readings there are larger extremes";
  EXPECT_GT(u_um({2.0, 0.0, 1.0}), std::sqrt(2.0 / 12.0)) << "steps of 1 um";
}

TEST(CircularDeviationNoise, OfASingleReadingThatIsFarOffIsThatOfTheOthers) {
  Stream stream(9, "bar");
  CirclePath path = Shown({2.0, 0.1, 0.0}, stream);
  path.points[123].d_m = 60.0 * um * path.points[123].slope.col(0);
  const Iso230_4Value far = CircularDeviations({path}, NearlyNothing())[0].Fmax_ccw;
  EXPECT_NEAR(far.u_m / um, 0.1, 0.02) << "no other reading is near it";
}

TEST(CircularDeviationNoise, OfAMeanInCoarseStepsIsNotThatOfSoManyReadings) {
  // 360 readings on the two sides of one step: as good as two rounding errors of half of the readings each.
  const auto show = [](PathPoint& point, const Eigen::Vector2d& outwards) {
    point.shown_m = outwards.y() >= 0.0 ? 0.0 : um;
    point.d_m = point.shown_m * outwards;
    point.u_own_m = Eigen::Vector2d::Constant(0.25 * um);
  };
  const CirclePath there = test::WrittenPath(1, 150.0 * mm, 360, 0.5 * deg, show),
                   back = test::WrittenPath(-1, 150.0 * mm, 360, 0.5 * deg, show);
  const Iso230_4Value d = CircularDeviations({there, back}, NearlyNothing())[0].D;
  EXPECT_NEAR(d.u_m / um, std::sqrt(4.0 / 16.0 / 12.0), 0.02);
}

}  // namespace
}  // namespace twinbench::benches::circular
