#include "tests/circular_motion/written_circles.h"
#include "tests/support/thresholds.h"
#include "twin/benches/circular_motion/analysis.h"
#include "twin/benches/circular_motion/bench.h"
#include "twin/core/stream.h"
#include "twin/report/sound.h"

// A bar without an encoder. Its readings are written here from what each error does to the path.
namespace twinbench::benches::circular {
namespace {

using namespace separate::circular;
using units::deg, units::mm, units::um, units::arcsec;

constexpr double kRadius_m = 150.0 * mm;

struct Machine {
  double squareness_rad = 0.0, scale_x = 0.0, scale_y = 0.0, backlash_x_m = 0.0;
  double centre_x_m = 0.0, centre_y_m = 0.0;
};

/// The spindle's distance from ball 1, which stands off the commanded centre, less the radius. The angle from +X to +Y is 90 deg +
/// squareness.
double Radial_m(const Machine& m, double a, int direction) {
  const double x_m = kRadius_m * std::cos(a), y_m = kRadius_m * std::sin(a);
  const double behind_m = test::Behind_m(kRadius_m, m.backlash_x_m, a, direction);
  return std::hypot(m.centre_x_m + x_m * (1.0 + m.scale_x) - m.squareness_rad * y_m + behind_m,
                    m.centre_y_m + y_m * (1.0 + m.scale_y)) -
         kRadius_m;
}

/// One circle each way.
std::vector<Reading> Readings(const Machine& m, double noise_m = 0.0, double arc_deg = 360.0) {
  Stream stream(5, "bar");
  return test::Written({kRadius_m, 1000.0 * mm / 60.0, 360, 0.25, 0.0, arc_deg}, [&](Reading& r, double a) {
    kBar_m(r) = Radial_m(m, a, r.direction) + noise_m * stream.Normal();
  });
}

Scenario Usual(std::vector<std::string> set = {}) {
  set.insert(set.end(), {"machine.lag_x_s=0", "machine.lag_y_s=0"});
  return test::ToldOfCircles("radial_bar", kRadius_m, set);
}

ErrorValue Found(const CircleAnalysis& a, const std::string& key) {
  for (const ErrorValue& e : ErrorsOf(a.fit)) {
    if (e.key == key) return e;
  }
  return {};
}

TEST(RadialBar, ShowsTheErrorsOfTheMachineThatItsReadingsWereMadeWith) {
  const Machine machine{6.0 * arcsec, 20e-6, -10e-6, 5.0 * um, 12.0 * um, -7.0 * um};
  const CircleAnalysis a = Analyse(Usual(), Readings(machine), Estimator::kRigorous);
  // Without noise; products of errors are neglected, 1e-4 of each.
  EXPECT_NEAR(Found(a, "machine.squareness_arcsec").value, 6.0, 1e-3);
  EXPECT_NEAR(Found(a, "machine.scale_mismatch_um_m").value, 30.0, 0.02);
  EXPECT_NEAR(Found(a, "machine.backlash_x_um").value, 5.0, 0.01);
  EXPECT_NEAR(Found(a, "machine.backlash_y_um").value, 0.0, 0.01);
  EXPECT_NEAR(a.fit.mountings[0].offset_m[0] / um, 12.0, 0.02);
  EXPECT_NEAR(a.fit.mountings[0].offset_m[1] / um, -7.0, 0.02);
  for (const char* key : {"machine.scale_x_um_m", "machine.lag_x_s", "encoder.eccentricity_arcsec", "bar.gain_error"})
    EXPECT_TRUE(Found(a, key).key.empty()) << key << " is not to be seen by a radius";
}

TEST(RadialBar, OfSquarenessAloneHasTheCircularDeviationsOfAnEllipse) {
  const double s = 10.0 * arcsec;
  for (const double centre_um : {0.0, 80.0}) {
    const CircleAnalysis a =
        Analyse(Usual(), Readings({s, 0.0, 0.0, 0.0, centre_um * um, 0.0}), Estimator::kRigorous);
    ASSERT_EQ(a.deviations.size(), 1U);
    const Iso230_4& d = a.deviations[0];
    // Along the radius squareness is -s R / 2 sin 2a: half axes R +- s R / 2. Of the angles none is that of an extreme, which
    // lowers them by 2 (0.25 deg)^2; s and the centre over the radius are neglected beside 1.
    const double half_um = 0.5 * s * kRadius_m / um;
    const double off_um = half_um * (2.0 * std::pow(0.25 * deg, 2) + s + 2.0 * centre_um * um / kRadius_m);
    EXPECT_NEAR(d.G_b.value_m / um, 2.0 * half_um, 2.0 * off_um);
    EXPECT_NEAR(d.G_mz_b.value_m / um, 2.0 * half_um, 2.0 * off_um) << "by symmetry its centre is the same";
    EXPECT_NEAR(d.Fmax_b.value_m / um, half_um, off_um);
    EXPECT_NEAR(d.Fmin_b.value_m / um, -half_um, off_um);
    EXPECT_NEAR(d.D.value_m / um, 0.0, 1e-3);
    EXPECT_NEAR(d.H.value_m / um, 0.0, 1e-3);
  }
}

TEST(RadialBar, OnAPartialArcIsEvaluatedAboutTheCentreOfThatArc) {
  const Machine machine{6.0 * arcsec, 0.0, 0.0, 0.0, 30.0 * um, -20.0 * um};
  const CircleAnalysis a = Analyse(Usual(), Readings(machine, 0.0, 230.0), Estimator::kRigorous);
  EXPECT_NEAR(Found(a, "machine.squareness_arcsec").value, 6.0, 1e-3);
  EXPECT_NEAR(a.fit.mountings[0].offset_m[0] / um, 30.0, 0.03);
  const double range_m = a.deviations[0].Fmax_b.value_m - a.deviations[0].Fmin_b.value_m;
  EXPECT_NEAR(range_m, a.deviations[0].G_b.value_m, 1e-12);
}

TEST(RadialBar, KeepsTheBallsFormAndTheGainThatTheScenarioStates) {
  std::vector<Reading> readings = Readings({6.0 * arcsec});
  for (Reading& r : readings) {
    const double a = std::atan2(kCommandedY_m(r), kCommandedX_m(r));
    kBar_m(r) = 1.02 * (kBar_m(r) + 0.5 * um * std::cos(2.0 * (a - 20.0 * deg)));
  }
  const Scenario scenario = Usual({"bar.gain_error=0.02", "bar.ball2_um=0.5", "bar.ball2_azimuth_deg=20"});
  const CircleAnalysis a = Analyse(scenario, readings, Estimator::kRigorous);
  EXPECT_NEAR(Found(a, "machine.squareness_arcsec").value, 6.0, 1e-3);
  EXPECT_NEAR(Found(a, "machine.scale_mismatch_um_m").value, 0.0, 0.02);
}

// Axes that answer 1 / (1 + lag s) make a circle smaller by half the square of lag times rate: at 6000 mm/min by 0.83 um, at
// 1000 mm/min by 0.02 um. Its length takes up one of both; the other was spikes of 0.5 um and backlash.
TEST(RadialBar, TakesTheSizeOfCirclesAtSeveralFeedsForWhatBothAxesLag) {
  constexpr double kLag_s = 5e-3;
  const auto show = [](Reading& r, double) {
    kBar_m(r) = kRadius_m / std::hypot(1.0, kLag_s * kFeed_m_s(r) / kRadius_m) - kRadius_m;
  };
  const std::vector<Reading> slow = test::Written({kRadius_m, 1.0 / 60.0}, show);
  const std::vector<Reading> readings = test::Written({kRadius_m, 6.0 / 60.0}, show, slow);
  const CircleAnalysis a = Analyse(Usual(), readings, Estimator::kRigorous);
  EXPECT_NEAR(Found(a, "machine.servo_mean_square_s2").value, kLag_s * kLag_s, 1e-3 * kLag_s * kLag_s);
  for (const char* key : {"machine.spike_x_um", "machine.spike_y_um", "machine.backlash_x_um", "machine.backlash_y_um"})
    EXPECT_NEAR(Found(a, key).value, 0.0, 1e-3) << key;
  const CircleAnalysis at_one_feed = Analyse(Usual(), Readings({}), Estimator::kRigorous);
  EXPECT_TRUE(Found(at_one_feed, "machine.servo_mean_square_s2").key.empty()) << "the length of the bar takes it up";
}

TEST(RadialBar, StatesUncertaintiesThatMatchItsErrors) {
  const Machine machine{6.0 * arcsec, 0.0, 0.0, 5.0 * um};
  const double noise_m = StatedNoiseOf(CircularOf(Usual()), true, kRadius_m).radial_m;
  const CircleAnalysis a = Analyse(Usual(), Readings(machine, noise_m), Estimator::kRigorous);
  // 720 values less some 15 unknowns: chi scatters by 1 / sqrt(2 * 705) = 0.027.
  EXPECT_NEAR(a.fit.chi, 1.0, 0.1);
  for (const auto& [key, value] : {std::pair{"machine.squareness_arcsec", 6.0}, {"machine.backlash_x_um", 5.0}, {"machine.servo_mismatch_s", 0.0}})
    EXPECT_NEAR(Found(a, key).value, value, 4.0 * Found(a, key).u) << key;
}

/// A path of radial deviations alone.
CirclePath PathOf(int direction, double first_deg, const std::function<double(double)>& radial_m) {
  return test::WrittenPath(direction, kRadius_m, 360, first_deg * deg, [&](PathPoint& p, const Eigen::Vector2d& outwards) {
    p.d_m = radial_m(p.commanded_rad) * outwards;
  });
}

TEST(CircularDeviations, HaveTheHysteresisBetweenReadingsAtOtherAngles) {
  const auto wave = [](double a) { return 3.0 * um * std::cos(3.0 * a); };
  const auto above = [&](double a) { return wave(a) + 1.5 * um; };
  const Iso230_4 d = CircularDeviations({PathOf(1, 0.0, wave), PathOf(-1, 0.37, above)}, {})[0];
  // A chord of 1 deg leaves the wave by (3 deg)^2 / 8 of it at most.
  EXPECT_NEAR(d.H.value_m / um, 1.5, 3.0 * std::pow(3.0 * deg, 2) / 8.0);
}

TEST(CircularDeviations, OfTheMinimumZoneAreThoseOfTheBestCentreOfAll) {
  const auto pear = [](double a) { return um * (std::cos(2.0 * a) + 0.8 * std::cos(3.0 * a + 0.4) + 2.0 * std::exp(-8.0 * std::pow(std::sin(0.5 * a - 0.3), 2))); };
  const CirclePath path = PathOf(1, 0.0, pear);
  Eigen::ArrayXd radial_um(360), cosine(360), sine(360);
  for (Eigen::Index k = 0; k < radial_um.size(); ++k) {
    const PathPoint& p = path.points[static_cast<std::size_t>(k)];
    radial_um[k] = p.Radial_m() / um;
    cosine[k] = std::cos(p.commanded_rad);
    sine[k] = std::sin(p.commanded_rad);
  }
  double best_um = 1e9;  // by looking everywhere, every 0.02 um: the best place is 0.014 from one of these
  for (double x = -1.0; x <= 1.0; x += 0.02) {
    for (double y = -1.0; y <= 1.0; y += 0.02) {
      const Eigen::ArrayXd off_um = radial_um - x * cosine - y * sine;
      best_um = std::min(best_um, off_um.maxCoeff() - off_um.minCoeff());
    }
  }
  const Iso230_4 d = CircularDeviations({path}, {})[0];
  EXPECT_NEAR(d.G_mz_ccw.value_m / um, best_um, 0.02);
  EXPECT_GT(d.G_ccw.value_m, d.G_mz_ccw.value_m + 0.01 * um);
  EXPECT_TRUE(std::isnan(d.G_b.value_m)) << "one direction is missing";
}

TEST(RadialBar, IsDiagnosedByItsRadiusAlone) {
  const diagnose::DiagnoseOptions options = test::QuickOptions(100);
  const double noise_m = StatedNoiseOf(CircularOf(Usual()), true, kRadius_m).radial_m;
  const diagnose::DiagnosisRun of_none = Diagnose(Readings({}, noise_m), Usual(), options);
  EXPECT_EQ(of_none.diagnosis.verdict, diagnose::Verdict::kNone);
  EXPECT_THAT(of_none.run.channels, testing::ElementsAre("radial"));
  const diagnose::Diagnosis d = Diagnose(Readings({3.0 * arcsec}, noise_m), Usual(), options).diagnosis;
  ASSERT_FALSE(d.causes.empty());
  EXPECT_EQ(d.causes[0].effect, "squareness");
  EXPECT_NEAR(d.causes[0].parameters[0].value / arcsec, 3.0, 4.0 * d.causes[0].parameters[0].u / arcsec);
}

TEST(RadialBar, OfLobesThatNoErrorMakesHasItsCircularDeviationsAndNoErrorThatIsNotThere) {
  std::vector<Reading> readings = Readings({}, 0.1 * um);
  for (Reading& r : readings) kBar_m(r) += 3.0 * um * std::cos(5.0 * std::atan2(kCommandedY_m(r), kCommandedX_m(r)) + 0.4);
  const report::Evaluation e = Evaluate(Usual(), readings, Estimator::kRigorous);
  for (const report::Misfit& misfit : e.misfits) EXPECT_LT(misfit.per_u, report::kMostMisfit);
  const CircleAnalysis a = Analyse(Usual(), readings, Estimator::kRigorous);
  EXPECT_NEAR(a.deviations[0].G_b.value_m / um, 6.0, 0.8) << "noise enlarges it by some four of its deviations at either end";
  for (const ErrorValue& error : ErrorsOf(a.fit)) {
    if (error.unit != "deg" && std::isfinite(error.u)) {
      EXPECT_LT(std::abs(error.value), 3.0 * error.u) << error.key;
    }
  }
}

TEST(CircularDeviations, OfAnArcHaveTheMeanOfTheCircleThatTheirRadiiAreAbout) {
  // Of cos 2a on an arc of 200 deg about 0: centre (x, 0) and radius by their two normal equations.
  const double half = 100.0 * deg;
  double c1 = 0.0, c2 = 0.0, r0 = 0.0, r1 = 0.0, n = 0.0;
  CirclePath there = PathOf(1, -100.0, [](double a) { return std::cos(2.0 * a) * um; });
  there.points.resize(201);
  CirclePath back = there;
  back.pass = 1, back.direction = -1;
  for (double a = -half; a <= half + 1e-9; a += deg) {
    const double radial = std::cos(2.0 * a);
    n += 1.0, c1 += std::cos(a), c2 += std::pow(std::cos(a), 2), r0 += radial, r1 += radial * std::cos(a);
  }
  const double mean_um = (c2 * r0 - c1 * r1) / (n * c2 - c1 * c1);
  const Iso230_4 d = CircularDeviations({there, back}, {})[0];
  EXPECT_NEAR(d.D.value_m / um, mean_um, 1e-9);
  EXPECT_LT(d.Fmin_b.value_m, d.D.value_m);
  EXPECT_GT(d.Fmax_b.value_m, d.D.value_m);
}

TEST(CircularDeviations, OfATurnThatIsNotQuiteClosedOrOfWhichAPartWasReadTwiceAreThoseOfTheTurn) {
  // Lobes of order 2 go into the centre of the rest of the turn by what they are in a gap of 16 deg: 0.28 / pi x 20 um.
  const double size_um = 20.0;
  for (const double phase : {0.0, 0.7, 1.6, 3.0}) {
    for (const double gap_deg : {8.0, 16.0}) {
      const auto lobes = [&](double a) { return size_um * um * std::cos(2.0 * a + phase); };
      CirclePath there = PathOf(1, 40.0, lobes), back = PathOf(-1, 40.0, lobes);
      for (CirclePath* path : {&there, &back}) path->points.resize(static_cast<std::size_t>(361.0 - gap_deg));
      const Iso230_4 d = CircularDeviations({there, back}, {})[0];
      EXPECT_NEAR(d.G_ccw.value_m / um, 2.0 * size_um, 0.02) << phase << ", " << gap_deg;
      EXPECT_NEAR(d.G_b.value_m / um, 2.0 * size_um, 0.02) << phase << ", " << gap_deg;
      EXPECT_NEAR(d.D.value_m / um, 0.0, 0.02) << phase << ", " << gap_deg;
    }
  }
  const auto lobes = [](double a) { return 20.0 * um * std::cos(2.0 * a + 0.7); };
  CirclePath path = PathOf(1, 0.0, lobes);
  const CirclePath again = PathOf(1, 0.5, lobes);
  path.points.insert(path.points.end(), again.points.begin(), again.points.begin() + 90);
  const Iso230_4 d = CircularDeviations({path}, {})[0];
  EXPECT_NEAR(d.G_ccw.value_m / um, 40.0, 0.02);
}

TEST(RadialBar, FarOffItsCentreHasNoLagOfBothAxesNamed) {
  const Machine machine{.backlash_x_m = 40.0 * um, .centre_x_m = 800.0 * um, .centre_y_m = -500.0 * um};
  const diagnose::Diagnosis d = Diagnose(Readings(machine, 0.3 * um), Usual(), test::QuickOptions(100)).diagnosis;
  for (const diagnose::Cause& cause : d.causes) EXPECT_NE(cause.effect, "servo_lag");
}

}  // namespace
}  // namespace twinbench::benches::circular
