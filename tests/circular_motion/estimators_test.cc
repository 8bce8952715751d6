#include "tests/circular_motion/oracle.h"
#include "tests/circular_motion/written_circles.h"
#include "twin/benches/circular_motion/analysis.h"
#include "twin/benches/circular_motion/twin/live.h"

namespace twinbench::benches::circular {
namespace {

using namespace separate::circular;
using units::mm, units::um;

/// 36 stops of a perfect circle under a bar whose ball stands off its centre.
std::vector<CirclePoint> OffCentre(const Eigen::Vector2d& offset_m) {
  constexpr int kStops = 36;
  std::vector<CirclePoint> points(kStops);
  for (int k = 0; k < kStops; ++k) {
    CirclePoint& p = points[static_cast<std::size_t>(k)];
    p.radius_m = 156.278 * mm;
    p.commanded_rad = k * units::turn / kStops;
    const Eigen::Vector2d v_m = offset_m + p.Commanded_m();
    p.radial_m = v_m.norm() - p.radius_m;
    p.tangential_m = p.radius_m * std::remainder(std::atan2(v_m.y(), v_m.x()) - p.commanded_rad, units::turn);
  }
  return points;
}

TEST(PublishedCircle, FindsTheCentreAndLeavesItsTangentialPart) {
  const std::vector<CirclePoint> points = OffCentre({20.0 * um, -12.0 * um});
  const Eigen::Vector2d offset_m = PublishedOffset_m(points);
  // By an independent implementation of the same equations; it agrees to the digits that it gave.
  EXPECT_NEAR(offset_m.x() / um, 19.999999944316965, 1e-7);
  EXPECT_NEAR(offset_m.y() / um, -11.999999966590826, 1e-7);
  double largest_um = 0.0, radial_um = 0.0;
  for (const CirclePoint& p : points) {
    const PathPoint at{p.commanded_rad, PublishedDeviation_m(p, offset_m)};
    largest_um = std::max(largest_um, at.d_m.norm() / um);
    radial_um = std::max(radial_um, std::abs(at.Radial_m()) / um);
  }
  EXPECT_NEAR(largest_um, 23.32056635769292, 1e-4);
  EXPECT_NEAR(radial_um, 0.003480009885231894, 1e-6);
}

TEST(RigorousCircle, LeavesNothingOfAnOffset) {
  const CircleMounting mounting{{20.0 * um, -12.0 * um}};
  for (const CirclePoint& p : OffCentre({20.0 * um, -12.0 * um}))
    EXPECT_LT(Deviation_m(p, {}, mounting, {1.0, 1.0, 1.0, 0.0}).norm(), 1e-15);
}

/// What the estimator leaves of a point of the bar that shows all of these.
double LeftOfShown_m(CirclePoint p, const CircleErrors& errors, const CircleMounting& mounting,
                     const CircleConstants& known) {
  p.is_bar = p.has_angle = true;
  const Eigen::Vector2d shown_m = Shown_m(p, errors, mounting, known);
  p.radial_m = shown_m.x();
  p.tangential_m = shown_m.y();
  return Deviation_m(p, errors, mounting, known).norm();
}

/// An encoder errs by where the bar is, and not by what it shows.
TEST(RigorousCircle, LeavesNothingOfAnEncoderThatErrsByADegreeOrIsAskew) {
  CircleErrors wavy;
  wavy.eccentricity_rad = {0.5 * units::deg, 0.4 * units::deg};
  wavy.ellipticity_rad = {-0.7 * units::deg, 0.7 * units::deg};
  for (const AxisPair& tilt_rad : {AxisPair{0.0, 0.0}, AxisPair{-0.1, 0.08}}) {
    const CircleConstants known{1.0, 1.0, 1.0, 5.0 * mm, 0.0, tilt_rad};
    for (const CirclePoint& p : OffCentre({0.0, 0.0})) {
      EXPECT_LT(LeftOfShown_m(p, wavy, {}, known), 1e-9) << tilt_rad[0] << " at " << p.commanded_rad;
    }
  }
}

TEST(RigorousCircle, LeavesNothingOfATransducerThatBendsByAThird) {
  CircleErrors bent;
  bent.bar_gain = -0.02;
  bent.bar_cubic_per_m2 = 800.0 / (mm * mm);
  const CircleMounting mounting{{20.0 * um, -12.0 * um}};
  for (const CirclePoint& p : OffCentre({20.0 * um, -12.0 * um}))
    EXPECT_LT(LeftOfShown_m(p, bent, mounting, {1.0, 1.0, 1.0, 0.0}), 1e-12);
}

/// The run of an independent implementation and what it was made with.
struct OracleRun {
  Scenario scenario;
  std::vector<Reading> readings;
  nlohmann::json truth;
};

OracleRun Oracle() {
  test::QuietCircles quiet;  // the grid is calibrated: its mean scale is the only measure of length
  quiet.Set("grid_scale_x_um_m", 2.0);
  quiet.Set("grid_scale_y_um_m", -1.0);
  return {quiet.Make(), test::OracleCircles(), test::OracleCirclesTruth()};
}

TEST(RigorousCircle, FindsWhatAnIndependentRunWasMadeWith) {
  const OracleRun run = Oracle();
  const CircleAnalysis a = Analyse(run.scenario, run.readings, Estimator::kRigorous);
  const nlohmann::json& p = run.truth["parameters"];
  std::map<std::string, ErrorValue> found;
  for (const ErrorValue& e : ErrorsOf(a.fit)) found[e.key] = e;
  // The readings are without noise: what is separable comes out far within its uncertainty (under stated noise).
  for (const char* name : {"scale_x_um_m", "scale_y_um_m", "squareness_arcsec", "backlash_x_um", "backlash_y_um",
                           "spike_x_um", "straightness_x_um", "lag_x_s", "lag_y_s", "cyclic_x_um", "bar_gain",
                           "ecc_arcsec", "ell_arcsec", "ball3_um"}) {
    const std::string key = test::QuietCircles::KeyOf(name);
    ASSERT_TRUE(found.contains(key)) << key;
    EXPECT_TRUE(std::isfinite(found[key].u)) << key << " is not separable";
    EXPECT_NEAR(found[key].value, p[name].get<double>(), 0.1 * found[key].u) << key;
  }
  EXPECT_LT(a.fit.rms_bar_m, 1e-9);
  EXPECT_LT(a.fit.rms_grid_m, 1e-9);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_NEAR(a.fit.mountings[k].offset_m[0] / um, p["offset_x_um"][k].get<double>(), 0.01);
    EXPECT_NEAR(a.fit.mountings[k].offset_m[1] / um, p["offset_y_um"][k].get<double>(), 0.01);
  }
}

TEST(RadialParts, OfBothAxesTogetherAreWhatIsSeenOnACircle) {
  CircleAnalysis a;
  a.known = {1.0, 1.0, 1.0, 0.0};
  a.points = OffCentre({0.0, 0.0});
  for (CirclePoint& p : a.points) p.is_bar = false, p.rate_rad_s = 0.1;
  a.fit.fitted = {0, 1, 4};  // lag of x and y, squareness
  a.fit.errors.lag_s = {1e-3, 1e-3};
  a.fit.errors.squareness_rad = 10.0 * units::arcsec;
  a.fit.setups = {0};
  a.fit.mountings.resize(1);
  const std::vector<RadialPart> parts = RadialPartsOf(a);
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_THAT(parts[0].keys, testing::ElementsAre("machine.squareness_arcsec"));
  // Radius times angle times sin cos, whose mean square is 1/8; the lag turns it by 1e-4.
  EXPECT_NEAR(parts[0].rms_m, 156.278 * mm * 10.0 * units::arcsec / std::sqrt(8.0), 1e-9);
  EXPECT_THAT(parts[1].keys, testing::ElementsAre("machine.lag_x_s", "machine.lag_y_s"));
  // Both as large turn the circle by 1e-4, and so the squareness's figure on it by twice as much; the radius shrinks by half the square.
  EXPECT_LT(parts[1].rms_m, 156.278 * mm * (0.5e-8 + 2e-4 * 10.0 * units::arcsec));
}

TEST(RigorousCircle, StatesNoUncertaintyOfWhatOneBarCannotTellApart) {
  OracleRun run = Oracle();
  std::erase_if(run.readings, [](const Reading& r) { return r.setup != 0; });
  const CircleAnalysis a = Analyse(run.scenario, run.readings, Estimator::kRigorous);
  for (const ErrorValue& e : ErrorsOf(a.fit)) {
    // Lag of both axes and latency of the encoder turn the path alike.
    EXPECT_FALSE(e.key == "encoder.latency_s" && !std::isnan(e.u));
    EXPECT_FALSE(e.key == "machine.backlash_x_um" && !std::isfinite(e.u));
  }
  EXPECT_THAT(a.fit.not_separable, testing::Contains(testing::HasSubstr("encoder.latency_s")));
}

/// Where the machine of the run was, without noise and instruments, on circles of 720 points.
std::vector<CirclePath> ActualPaths(const nlohmann::json& parameters) {
  test::QuietCircles quiet;
  for (const auto& [name, value] : parameters.items()) {
    if (value.is_number() && !name.starts_with("grid")) quiet.Set(name, value.get<double>());
  }
  Scenario scenario = quiet.Make();
  scenario.noise_free = true;
  CircularProcedureSettings& procedure = CircularOf(scenario).procedure;
  procedure.setups = {{"bar", 110.230 * mm}, {"bar", 156.278 * mm}};
  procedure.feeds_m_s = {40.0 * mm / 60.0};
  procedure.points = 720;
  procedure.stops = 0;
  std::vector<CirclePath> paths;
  const nlohmann::json truth = sim::CircleRun(scenario).Truth();
  for (const nlohmann::json& pass : truth["path"]) {
    const int setup = pass["setup"], number = pass["pass"];
    CirclePath& path = paths.emplace_back(
        CirclePath{setup, number, number == 0 ? 1 : -1, true, setup == 0 ? 110.230 * mm : 156.278 * mm, 1.0, {}});
    for (std::size_t i = 0; i < pass["dx_um"].size(); ++i) {
      PathPoint& point = path.points.emplace_back();
      point.commanded_rad = pass["commanded_deg"][i].get<double>() * units::deg;
      point.d_m = um * Eigen::Vector2d(pass["dx_um"][i].get<double>(), pass["dy_um"][i].get<double>());
    }
  }
  return paths;
}

TEST(CircularDeviations, AgreeWithAnIndependentImplementation) {
  const OracleRun run = Oracle();
  const std::vector<Iso230_4> found = CircularDeviations(ActualPaths(run.truth["parameters"]), {});
  ASSERT_EQ(found.size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    const nlohmann::json& expected = run.truth["iso230_4_um"][k == 0 ? "110.230" : "156.278"];
    for (const auto& [name, value] : NamedValues(found[k])) {
      // Its F are about the commanded centre, and it has no minimum zone.
      if (name.starts_with("F") || name.starts_with("G_mz")) continue;
      // The least-squares centre of first order: its distance squared over the radius.
      EXPECT_NEAR(value.value_m / um, expected[name].get<double>(), 1e-3) << name << " at radius " << k;
    }
    EXPECT_NEAR(found[k].Fmax_b.value_m - found[k].Fmin_b.value_m, found[k].G_b.value_m, 1e-12) << "about the same centre";
  }
}

constexpr double kRounding = 1e-12;
constexpr int kPoints = 8, kHighest = 1, kLowest = 6;

/// What the uncertainties of ISO 230-4 are made of, against sums by hand: one unknown that makes the radius larger by as much, known to 0.2 um: a quarter of the variance is left over beyond what is stated, another
/// quarter the machine's.
SharedUncertainty OfTheLength() {
  SharedUncertainty shared = test::SharedLength(0.2 * um);
  shared.of_machine = 0.25 * shared.cov;
  shared.excess = 0.25;
  return shared;
}

/// A circle with one reading far out (u 0.3 um, half of it the machine's, a tenth the quanta's) and one far in (0.4 um; a fifth, none).
/// @param beyond_um  Of the one far out.
CirclePath Circle(int direction, double beyond_um = 0.0) {
  int i = 0;
  return test::WrittenPath(direction, 0.1, kPoints, 0.0, [&](PathPoint& point, const Eigen::Vector2d& outwards) {
    const bool is_high = i == kHighest;
    point.d_m = um * (is_high ? 9.0 + beyond_um : i == kLowest ? -9.0 : 0.0) * outwards;
    point.u_own_m = um * Eigen::Vector2d::Constant(is_high ? 0.3 : 0.4);
    point.of_machine.setConstant(is_high ? 0.5 : 0.2);
    point.of_steps.setConstant(is_high ? 0.1 : 0.0);
    ++i;
  });
}

void ExpectParts(const Iso230_4Value& value, double variance_um2, double machine_um2, double steps_um2) {
  EXPECT_NEAR(std::pow(value.u_m / um, 2), variance_um2, kRounding);
  EXPECT_NEAR(value.repeatability, machine_um2 / variance_um2, kRounding);
  EXPECT_NEAR(value.quantisation, steps_um2 / variance_um2, kRounding);
  EXPECT_EQ(value.model, 0.0);
}

TEST(CircularDeviationParts, AreThoseOfTheReadingsAndOfWhatTheyShare) {
  const std::vector<Iso230_4> found = CircularDeviations({Circle(1), Circle(-1, 1.0)}, OfTheLength());
  ASSERT_EQ(found.size(), 1U);
  const double high = 0.09, high_machine = 0.045, high_steps = 0.009, low = 0.16, low_machine = 0.032;
  const double shared = 0.04, shared_machine = 0.5 * shared;
  ExpectParts(found[0].G_ccw, high + low, high_machine + low_machine, high_steps);
  ExpectParts(found[0].Fmax_ccw, high + shared, high_machine + shared_machine, high_steps);
  ExpectParts(found[0].Fmin_ccw, low + shared, low_machine + shared_machine, 0.0);
  ExpectParts(found[0].H, 2.0 * high, 2.0 * high_machine, 2.0 * high_steps);
}

TEST(CircularDeviationParts, OfAMeanHaveTheOwnNoiseAveraged) {
  const Iso230_4Value d = CircularDeviations({Circle(1), Circle(-1)}, OfTheLength())[0].D;
  const double square = std::pow(1.0 / (2.0 * kPoints), 2), shared = 0.04;
  const double own = 2.0 * square * (0.09 + 7.0 * 0.16), own_machine = 2.0 * square * (0.045 + 7.0 * 0.032);
  ExpectParts(d, own + shared, own_machine + 0.5 * shared, 2.0 * square * 0.009);
}

}  // namespace
}  // namespace twinbench::benches::circular
