#include "tests/support/noise.h"
#include "tests/support/over_seeds.h"
#include "twin/benches/rotary_4dof/columns.h"
#include "twin/benches/rotary_4dof/estimators/far_readings.h"
#include "twin/benches/rotary_4dof/estimators/probe_separation.h"
#include "twin/benches/rotary_4dof/estimators/standing_orders.h"
#include "twin/core/units.h"

// Displacement probes at an artefact that turns: the motions that the readings were made of, in closed form.
namespace twinbench::separate::rotary {
namespace {

using benches::rotary::ProbeRadial_m;
using units::um;

using Curve = std::function<double(double)>;  // of an angle [rad], in um

double AxisX_um(double a) { return 0.5 * std::cos(2.0 * a) + 0.3 * std::sin(5.0 * a); }
double AxisY_um(double a) { return 0.4 * std::cos(3.0 * a + 0.6); }
double Artefact_um(double a) { return 0.8 * std::cos(3.0 * a) + 0.35 * std::sin(4.0 * a + 0.2); }

/// Of three probes that tell all low orders.
const std::vector<double> kApart_rad = {0.0, 100.0 * units::deg, 213.0 * units::deg};

struct Spun {
  std::vector<double> at_rad;  // of the probes
  int turns = 6, angles = 120;
  double noise_um = 0.0, off_deg = 0.0;  // off_deg: readings that lie beside the grid, by turn
  bool both = false;                     // a second mounting, reversed
  std::uint64_t seed = 3;
};

std::vector<Reading> Made(const Spun& of, const Curve& artefact_um) {
  twinbench::test::Noise noise(of.noise_um, of.seed);
  std::vector<Reading> readings;
  for (int setup = 0; setup < (of.both ? 2 : 1); ++setup) {
    for (int k = 0; k < of.turns * of.angles; ++k) {
      const double a = units::turn * k / of.angles + of.off_deg * units::deg * (k / of.angles);
      Reading& r = readings.emplace_back();
      r.setup = setup;
      r.pass = setup;
      r.target_rad = std::fmod(a, units::turn);
      for (std::size_t i = 0; i < of.at_rad.size(); ++i) {
        const double f = of.at_rad[i], axis_um = AxisX_um(a) * std::cos(f) + AxisY_um(a) * std::sin(f);
        ProbeRadial_m(static_cast<int>(i))(r) =
            (artefact_um(a - f) + 7.0 * std::cos(a - f) + (setup == 0 ? axis_um : -axis_um) + noise()) * um;
      }
    }
  }
  return readings;
}

RadialMotion Separated(const Spun& of, const Curve& artefact_um) {
  std::vector<Quantity> columns;
  std::vector<std::size_t> radial;
  for (std::size_t i = 0; i < of.at_rad.size(); ++i) {
    columns.push_back(ProbeRadial_m(static_cast<int>(i)));
    radial.push_back(i);
  }
  return SeparateRadial(TurnsOf(Made(of, artefact_um), columns), radial, of.at_rad, of.both ? 1 : -1);
}

/// Order 1 and the constant aside.
void ExpectCurve(const ErrorMotion& motion, const Curve& truth_um, double within_um, const char* what) {
  Eigen::ArrayXd rest = motion.contour / um - motion.angle_rad.unaryExpr(truth_um);
  for (const Eigen::ArrayXd& wave :
       {Eigen::ArrayXd(motion.angle_rad.array().cos()), Eigen::ArrayXd(motion.angle_rad.array().sin())})
    rest -= 2.0 * (wave * rest).mean() * wave;
  EXPECT_LT((rest - rest.mean()).abs().maxCoeff(), within_um) << what;
}

TEST(ProbeMotion, OfTwoProbesHasTheArtefactInIt) {
  const RadialMotion two = Separated({.at_rad = {0.0, 0.5 * units::kPi}}, [](double) { return 0.0; });
  EXPECT_EQ(two.separated_by, "");
  ExpectCurve(*two.x, AxisX_um, 1e-9, "x");
  ExpectCurve(*two.y, AxisY_um, 1e-9, "y");
  ExpectCurve(
      *two.rotating, [](double a) { return AxisX_um(a) * std::cos(a) + AxisY_um(a) * std::sin(a); }, 1e-9,
      "along a direction that turns");
  EXPECT_FALSE(two.artefact);
}

TEST(ProbeMotion, OfProbesThatStandAskewIsAlongXAndY) {
  const RadialMotion two = Separated({.at_rad = {0.3, 1.5}}, [](double) { return 0.0; });
  ExpectCurve(*two.x, AxisX_um, 1e-9, "x");
  ExpectCurve(*two.y, AxisY_um, 1e-9, "y");
}

TEST(ProbeMotion, IsSeparatedByReversal) {
  for (const std::vector<double>& at : {std::vector<double>{0.0}, std::vector<double>{0.0, 0.5 * units::kPi}}) {
    const RadialMotion motion = Separated({.at_rad = at, .both = true}, Artefact_um);
    EXPECT_EQ(motion.separated_by, "reversal");
    ExpectCurve(at.size() == 1 ? *motion.along : *motion.x, AxisX_um, 1e-9, "x");
    if (motion.y) ExpectCurve(*motion.y, AxisY_um, 1e-9, "y");
    ExpectCurve(*motion.artefact, Artefact_um, 1e-9, "artefact");
  }
}

TEST(ProbeMotion, IsSeparatedByProbesWhereTheirAnglesTellIt) {
  const RadialMotion three = Separated({.at_rad = kApart_rad}, Artefact_um);
  EXPECT_EQ(three.separated_by, "probes");
  EXPECT_TRUE(std::ranges::none_of(three.lost_orders, [](int order) { return order < 15; }));
  ExpectCurve(*three.x, AxisX_um, 1e-9, "x");
  ExpectCurve(*three.y, AxisY_um, 1e-9, "y");
  ExpectCurve(*three.artefact, Artefact_um, 1e-9, "artefact");
}

/// At every third of a turn an artefact's orders 3 n show the same to all probes, which no motion of an axis does,
/// and 3 n +- 1 what a motion shows.
TEST(ProbeMotion, NamesOrdersThatEvenlySpacedProbesDoNotTell) {
  const RadialMotion three = Separated({.at_rad = {0.0, units::turn / 3.0, 2.0 * units::turn / 3.0}}, Artefact_um);
  std::vector<int> lost;
  for (int order = 2; order < 60; ++order) {
    if (order % 3 != 0) lost.push_back(order);
  }
  EXPECT_EQ(three.lost_orders, lost);
}

TEST(ProbeMotion, TakesReadingsAtOtherAnglesFromTurnToTurn) {
  const std::vector<Quantity> columns = {ProbeRadial_m(0)};
  const std::vector<ProbeTurns> turns =
      TurnsOf(Made({.at_rad = {0.0}, .angles = 720, .off_deg = 0.2}, [](double) { return 0.0; }), columns);
  ASSERT_EQ(turns.size(), 1U);
  EXPECT_TRUE(turns[0].is_interpolated);
  EXPECT_GE(turns[0].Turns(), 5);
  ExpectCurve(OfTurns(turns[0].angle_rad, turns[0].shown[0]), AxisX_um, 1e-3, "between the readings");
  EXPECT_TRUE(TurnsOf({}, columns).empty());
}

/// The spread of what comes out, over many runs, is the u that is stated: of the contour at one angle.
TEST(ProbeMotion, StatesWhatItScattersBy) {
  // Of x and of the artefact: squared errors, and what is stated of them.
  const Eigen::Array22d of = twinbench::test::MeanOverSeeds(60, [](std::uint64_t seed) {
    const RadialMotion m =
        Separated({.at_rad = kApart_rad, .turns = 4, .angles = 60, .noise_um = 0.02, .seed = seed},
                  [](double) { return 0.0; });
    const Eigen::VectorXd x_um = m.x->contour / um - m.x->angle_rad.unaryExpr(&AxisX_um);
    return Eigen::Array22d{
        {x_um.squaredNorm() / 60.0, m.x->cov.diagonal().mean() / (um * um)},
        {(m.artefact->contour / um).squaredNorm() / 60.0, m.artefact->cov.diagonal().mean() / (um * um)}};
  });
  EXPECT_NEAR(of(0, 0) / of(0, 1), 1.0, 0.1);
  EXPECT_NEAR(of(1, 0) / of(1, 1), 1.0, 0.15);
}

/// A wave of 0.8 um in noise of 0.04 um at 720 angles: the points of the mean turn lie 2 x 0.8 um apart and some
/// noise more, the wave does not, and in 40 runs the truth lies within what is stated as a normal number does.
TEST(ProbeMotion, KeepsOrdersThatStandOutOfNoise) {
  const Eigen::Array2d of = twinbench::test::MeanOverSeeds(40, [](std::uint64_t seed) {
    twinbench::test::Noise noise(0.04, seed);
    const Eigen::VectorXd angle_rad = Eigen::VectorXd::LinSpaced(720, 0.0, units::turn * 719.0 / 720.0);
    const Eigen::MatrixXd turns = Eigen::MatrixXd::NullaryExpr(
        3, 720, [&](Eigen::Index, Eigen::Index k) { return (0.8 * std::cos(2.0 * angle_rad[k]) + noise()) * um; });
    const ErrorMotion plain = OfTurns(angle_rad, turns), standing = OfStandingOrders(plain);
    for (Eigen::Index k = 0; k < 720; k += 90)
      EXPECT_NEAR(standing.contour[k] + standing.scatter[static_cast<std::size_t>(k)][1], turns(1, k), 1e-15)
          << "a turn is what it was";
    const auto value = EvaluateErrorMotion(standing, PlotCentre::kLeastSquares, {100, seed}).synchronous;
    return Eigen::Array2d(std::pow((value.value / um - 1.6) / (value.u / um), 2),
                          (plain.contour.maxCoeff() - plain.contour.minCoeff()) / um);
  });
  EXPECT_NEAR(of[0], 1.0, 0.6);
  EXPECT_GT(of[1], 1.68) << "what this is good for";
  const ErrorMotion one = OfTurns(Eigen::VectorXd::LinSpaced(8, 0.0, 5.0), Eigen::RowVectorXd::Random(8));
  EXPECT_EQ(OfStandingOrders(one).contour, one.contour) << "of one turn no noise is known";
}

/// A chip below a probe in one turn is no motion of the axis; a scratch of the artefact comes round in every turn, and in a
/// single one nothing tells the two apart.
TEST(ProbeMotion, IsNotOfAReadingThatOneTurnHasAndNoOther) {
  constexpr std::size_t kChip = 250;
  const Quantity column = ProbeRadial_m(0);
  const auto with_scratch = [&column](int turns) {
    std::vector<Reading> readings = Made({{0.0}, turns, 120, 0.02}, Artefact_um);
    for (std::size_t i = 0; i < readings.size(); ++i) {
      readings[i].reading = static_cast<int>(i);
      if (i % 120 == 60) column(readings[i]) += 5.0 * um;
    }
    return readings;
  };
  std::vector<Reading> scratched = with_scratch(4), once = with_scratch(1);
  EXPECT_TRUE(ReplaceFar({column}, scratched).empty());
  EXPECT_TRUE(ReplaceFar({column}, once).empty());
  std::vector<Reading> chipped = scratched;
  column(chipped[kChip]) += 5.0 * um;
  const std::vector<FarReading> far = ReplaceFar({column}, chipped);
  ASSERT_EQ(far.size(), 1U);
  EXPECT_EQ(far[0].reading, static_cast<int>(kChip));
  EXPECT_NEAR(far[0].off / um, 5.0, 0.1);
  EXPECT_NEAR(column(chipped[kChip]) / um, column(scratched[kChip]) / um, 0.1);
}

/// Readings of one turn are lost: the turns on both sides stay.
TEST(ProbeMotion, SaysHowManyTurnsHaveGaps) {
  std::vector<Reading> readings = Made({{0.0}, 5, 120, 0.0}, Artefact_um);
  readings.erase(readings.begin() + 290, readings.begin() + 296);
  const std::vector<ProbeTurns> turns = TurnsOf(readings, {ProbeRadial_m(0)});
  ASSERT_EQ(turns.size(), 1U);
  EXPECT_EQ(turns[0].Turns(), 4);
  EXPECT_EQ(turns[0].incomplete, 1);
}

}  // namespace
}  // namespace twinbench::separate::rotary
