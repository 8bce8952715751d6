#include "tests/diagnose/encoder_fit.h"
#include "tests/diagnose/support/synthetic_run.h"
#include "tests/support/kept_text.h"
#include "twin/benches/encoder_comparison/bench.h"
#include "twin/benches/encoder_comparison/diagnosis/family_parts.h"
#include "twin/benches/encoder_comparison/diagnosis/signals.h"
#include "twin/core/units.h"
#include "twin/model/signals.h"
#include "twin/model/wave_grid.h"

namespace twinbench::diagnose::encoder {
namespace {

using units::deg, units::kPi;

SignalContext Steps(const std::vector<double>& angle_deg, const std::vector<int>& direction) {
  const auto n = std::ssize(angle_deg);
  Schedule s = PlainSchedule(static_cast<int>(n));
  s.time_s = Eigen::VectorXd::LinSpaced(n, 0.0, static_cast<double>(n - 1));
  s.reference_rad = Eigen::Map<const Eigen::VectorXd>(angle_deg.data(), n) * deg;
  s.direction = direction;
  return ContextOf(s, s.reference_rad, {});
}

TEST(LeastOrder, ShowsMostOfAPeriodInOneSetUpAndAllOfItWhereNoReasonSpeaksForIt) {
  const auto of_range = [](double range_deg) { return LeastOrder(Steps({0.0, range_deg}, {1, 1})); };
  EXPECT_EQ(of_range(360.0), 1);
  EXPECT_EQ(of_range(270.0), 1) << "a scale off its axis, in a joint";
  EXPECT_EQ(of_range(120.0), 2);
  EXPECT_EQ(of_range(90.0), 4) << "order 3 would be 0.75 of a period";
  EXPECT_EQ(of_range(59.0), 6);
  SignalContext two = Steps({0.0, 59.0, 100.0, 159.0}, {1, 1, 1, 1});
  EXPECT_EQ(LeastOrder(two), 2);
  two.setup = {0, 0, 1, 1};
  EXPECT_EQ(LeastOrder(two), 6) << "each stands where it likes";
}

/// A single step is a slip.
TEST(LostCounts, AreOfferedWhereASpotIsPassedAgain) {
  unknown::Design design;
  design.channels = {"device"};
  design.places = {{"", "device", Eigen::MatrixXd::Ones(1, 1)}};
  const auto families = [&](const std::vector<double>& angle_deg) {
    return LostCountFamilies(Steps(angle_deg, std::vector<int>(angle_deg.size(), 1)), design).size();
  };
  EXPECT_EQ(families({5, 95, 185, 275, 355}), 0u) << "each once";
  EXPECT_GT(families({5, 95, 185, 275, 355, 445, 535, 625, 715, 805}), 0u);
}

TEST(WaveGrid, IsTheWaveOfEachGridPoint) {
  const Eigen::VectorXd phase = Eigen::VectorXd::LinSpaced(50, -3.0, 125.0);  // twenty turns
  constexpr int kCount = 5972;
  const model::WaveGrid grid(phase, 0.3, 0.01, kCount);
  for (const int g : {0, 1, 77, 78, 79, 3000, kCount - 1})
    EXPECT_LT((grid.At(g) - model::Wave((0.3 + 0.01 * g) * phase)).cwiseAbs().maxCoeff(), 1e-11) << g;
  EXPECT_LT((model::WaveGrid(phase, 2.0, 1.0, 1).At(0) - model::Wave(2.0 * phase)).norm(), 1e-12);
}

TEST(Sense, IsThatOfTheLastMotionWhereItHoldsAtRest) {
  const SignalContext c = Steps({0, 1, 1, 0, 0}, {0, 1, 0, -1, 0});
  EXPECT_EQ(Sense(c, true), (Eigen::VectorXd(5) << 1, 1, 1, -1, -1).finished());
  EXPECT_EQ(Sense(c, false), (Eigen::VectorXd(5) << 0, 1, 0, -1, 0).finished());
}

TEST(Senses, AreThoseThatDifferOnTheSchedule) {
  const SignalContext stops = Steps({0, 1, 1, 0}, {1, 1, -1, -1});
  const auto senses = Senses(stops);
  ASSERT_EQ(senses.size(), 2u);
  EXPECT_EQ(senses[0], (Eigen::VectorXd(4) << 1, 1, -1, -1).finished());
  EXPECT_EQ(senses[1], (Eigen::VectorXd(4) << 1, 1, 1, -1).finished()) << "at the turning stop nothing has moved";
  EXPECT_EQ(Senses(Steps({0, 1, 2}, {1, 1, 1})).size(), 1u);
}

TEST(Travel, BeginsAnewWhereTheShaftWentBack) {
  SignalContext c = Steps({0, 10, 20, 10, 0, 0, -10}, {1, 1, 1, -1, -1, -1, -1});
  c.pass = {0, 0, 0, 1, 1, 2, 2};
  EXPECT_TRUE(
      TravelSinceReversal_rad(c).isApprox(deg * (Eigen::VectorXd(7) << 0, 10, 20, 0, 10, 10, 20).finished()))
      << "the third pass goes on where the second one ended";
  SignalContext returned = Steps({20, 10, 0, 20, 10}, {-1, -1, -1, -1, -1});
  EXPECT_TRUE(TravelSinceReversal_rad(returned).isApprox(deg * (Eigen::VectorXd(5) << 0, 10, 20, 0, 10).finished()))
      << "on the way back to 20 it was driven the other way";
}

TEST(Relaxation, CountsTheRunUpToAStop) {
  const SignalContext c = Steps({0, 20}, {1, -1});  // beyond 20 by 5 and back by 5
  const Eigen::MatrixXd states = Relaxation(c, 20.0 * deg, 5.0 * deg);
  const double first = 1.0 - std::exp(-0.25);
  const double beyond = 1.0 + (first - 1.0) * std::exp(-1.25);
  EXPECT_NEAR(states(0, 0), first, 1e-12);
  EXPECT_NEAR(states(1, 0), -1.0 + (beyond + 1.0) * std::exp(-0.25), 1e-12);
}

// What named families have that their slopes (named_families_test.cc) do not say.

using test::EncoderEffect, test::EncoderScenario;

EncoderRun With(const EffectSettings& effect, const Scenario& scenario) {
  return RunOf(test::ReadingsWith(scenario, effect), scenario);
}

std::vector<Family> CleanFamilies() {
  const Scenario scenario = EncoderScenario();
  return Families(RunOf(twinbench::test::RunEncoderTwin(scenario).readings, scenario));
}

// A quarter turn between the set-ups: an order 1 locked to the device explains half of the variance.
TEST(EncoderFamilies, TellAFaultyReferenceFromADeviceThatWasTurned) {
  Scenario scenario = EncoderScenario();
  EncoderOf(scenario).encoder_procedure.mounting_rad = {0.0, 90.0 * deg};
  const EncoderRun encoder =
      With(EncoderEffect("reference_fault", {{"order", 1.0}, {"amplitude", 1e-5}}), scenario);
  EXPECT_NEAR(test::BestFit(test::FamilyOf(Families(encoder), "eccentricity"), encoder.run).left, std::sqrt(0.5),
              0.02);
}

TEST(EncoderFamilies, KeepMismatchAndQuadratureApartWhereTheZeroIsKnown) {
  Scenario scenario = EncoderScenario();
  EncoderOf(scenario).device.signal_zero_known = true;
  const EncoderRun encoder = With(EncoderEffect("amplitude_mismatch", {{"ratio", 2e-5}}), scenario);
  EXPECT_GT(test::BestFit(test::FamilyOf(Families(encoder), "quadrature_error"), encoder.run).left, 0.99);
}

// Its zero is taken from the mean offset of the run, which the clipping shifts a little.
TEST(EncoderFamilies, RecoverClippingWithTheZeroFree) {
  const Scenario scenario = EncoderScenario("sweep");
  Scenario turned = scenario;  // what is diagnosed is not told of this
  EncoderOf(turned).device.signal_zero_rad = 33.75 * deg;
  const auto readings = test::ReadingsWith(turned, EncoderEffect("signal_clipping", {{"level", 0.90}}));
  const EncoderRun encoder = RunOf(readings, scenario);
  Family family = test::FamilyOf(Families(encoder), "signal_clipping");
  const test::Fit grid = test::BestFit(family, encoder.run);
  EXPECT_LT(grid.left, 0.15);
  EXPECT_NEAR(family.ShapeAt(grid.grid_point)[0], 0.90, 0.04);
  family.columns = [&](int) { return family.at(Eigen::Vector2d(0.90, 33.75 * deg)); };
  const test::Fit exact = test::FitAt(family, 0, encoder.run);
  EXPECT_LT(exact.left, 0.02);
  EXPECT_NEAR(exact.amplitudes[0], 1.0, 0.02);
}

TEST(EncoderFamilies, GiveCausesOfOneOrderTheSameColumnsAndPriors) {
  const auto families = CleanFamilies();
  const auto scaled = [&](const char* name) {
    const Family& family = test::FamilyOf(families, name);
    Eigen::MatrixXd columns = family.ColumnsAt(0);
    for (Eigen::Index j = 0; j < columns.cols(); ++j) columns.col(j) *= family.amplitudes[j].prior_sd;
    return Eigen::MatrixXd(columns * columns.transpose());  // the prior covariance of the signal
  };
  for (const auto& [a, b] :
       {std::pair{"eccentricity", "signal_offset"}, std::pair{"ellipticity", "amplitude_mismatch"},
        std::pair{"ellipticity", "quadrature_error"}})
    EXPECT_LT((scaled(a) - scaled(b)).norm(), 1e-9 * scaled(a).norm()) << a << " " << b;
}

TEST(EncoderNextMeasurement, SplitsWhatOneRunCannot) {
  using benches::encoder::NextMeasurement;
  for (const auto& [a, b] : {std::pair{"signal_offset", "eccentricity"}, std::pair{"hysteresis", "backlash"},
                             std::pair{"backlash", "latency"}, std::pair{"eccentricity", "reference_fault"}})
    EXPECT_KEPT(NextMeasurement(a, b));
  for (const EffectEntry& a : EffectCatalogue(kEncoderBench)) {
    for (const EffectEntry& b : EffectCatalogue(kEncoderBench)) {
      EXPECT_FALSE(NextMeasurement(a.name, b.name).empty());
      EXPECT_EQ(NextMeasurement(a.name, b.name), NextMeasurement(b.name, a.name));
    }
  }
}

TEST(EncoderFamilies, LetHysteresisBeginWithNoMoreThanItsLagAndStateUncertaintiesOfShapesThatTheCovarianceHas) {
  const auto families = CleanFamilies();
  const Family& family = test::FamilyOf(families, "hysteresis");
  ASSERT_EQ(family.amplitudes.size(), 1u) << "a decay from the start without a lag is no hysteresis";
  EXPECT_EQ(family.shapes[1].lower, -1.0);
  EXPECT_EQ(family.shapes[1].upper, 1.0);
  const Eigen::Vector4d sd(1e-6, 0.2, 0.1, 0.3);  // lag, settles_over, start, approach
  const Eigen::MatrixXd cov = sd.array().square().matrix().asDiagonal();
  const Eigen::Vector3d shape(0.5, 0.04, 1.0);
  const Eigen::VectorXd x = Eigen::VectorXd::Constant(1, 1e-4);
  EXPECT_NEAR(family.parameters(shape, x, cov)[1].u, 0.2, 1e-12);
  EXPECT_TRUE(std::isnan(family.parameters(shape, x, cov.topLeftCorner<1, 1>())[1].u)) << "held fixed";
  const Family& clipping = test::FamilyOf(families, "signal_clipping");
  const Eigen::Matrix3d cov_clipping = Eigen::Vector3d(1e-2, 4e-8, 1e-4).asDiagonal();  // strength, level, zero
  EXPECT_NEAR(clipping.parameters(Eigen::Vector2d(0.98, 0.0), Eigen::VectorXd::Ones(1), cov_clipping)[0].u, 2e-4,
              1e-12);
}

TEST(EncoderFamilies, StateThePositiveSizeOfAWaveWithUncertaintiesThatFollowFromTheCovariance) {
  const auto families = CleanFamilies();
  const Family& family = test::FamilyOf(families, "eccentricity");
  const Eigen::Matrix2d cov = Eigen::Vector2d(1e-12, 4e-12).asDiagonal();
  const auto parameters = family.parameters({}, Eigen::Vector2d(3e-4, 4e-4), cov);
  EXPECT_NEAR(parameters[0].value, 5e-4, 1e-15);
  // Along (0.6, 0.8): 0.36 * 1 + 0.64 * 4 = 2.92; across (-0.8, 0.6): 0.64 * 1 + 0.36 * 4 = 2.08, over the size.
  EXPECT_NEAR(parameters[0].u, std::sqrt(2.92e-12), 1e-15);
  EXPECT_NEAR(parameters[1].u, std::sqrt(2.08e-12) / 5e-4, 1e-12);
  for (const double phase_rad : {-3.0, -0.3, 0.4, 2.9}) {
    for (const double size : {-1e-5, 1e-5}) {
      const Eigen::Vector2d wave = size * Eigen::Vector2d(std::cos(phase_rad), -std::sin(phase_rad));
      const auto found = family.parameters({}, wave, cov);
      EXPECT_NEAR(found[0].value, 1e-5, 1e-15);
      EXPECT_GE(found[1].value, 0.0);
      EXPECT_NEAR(std::remainder(found[1].value - phase_rad - (size < 0.0 ? units::kPi : 0.0), units::turn), 0.0,
                  1e-9);
    }
  }
}

// The generic families for what the catalogue has not.

using test::EncoderScenario;
using units::deg;

/// Readings of an ideal device with a signal on them, as a function of the reading [rad].
template <class Signal>
EncoderRun RunWith(const std::string& kind, Signal signal) {
  const Scenario scenario = EncoderScenario(kind);
  auto readings = twinbench::test::RunEncoderTwin(scenario).readings;
  for (Reading& r : readings) r.measured_rad += signal(r);
  return RunOf(readings, scenario);
}

/// What the best family of a sort leaves, and its words for it.
std::pair<double, std::string> BestOfSort(const EncoderRun& encoder, const std::string& sort,
                                          const std::vector<std::string>& excluded = {}) {
  double left = 2.0;
  std::string words;
  for (const Family& family : Families(encoder, excluded)) {
    if (family.group != sort) continue;
    const test::Fit fit = test::BestFit(family, encoder.run);
    if (fit.left >= left) continue;
    left = fit.left;
    words = family.describe(fit.grid_point, fit.amplitudes, family.shapes.empty() ? Eigen::VectorXd() : family.ShapeAt(fit.grid_point));
  }
  return {left, words};
}

struct Structure {
  const char *kind, *sort;
  std::function<double(const Reading&)> signal;
  double left;        // at most
  const char* words;  // a regular expression
};

TEST(EncoderUnknown, FindsLinesMapsTonesWanderPassesAndWhatGrowsWithTimeOrSpeed) {
  const auto direction_map = [](const Reading& r) { return 1e-4 * r.direction * std::sin(3.0 * r.reference_rad); };
  const auto tone = [](const Reading& r) { return 1e-4 * std::cos(2.0 * units::kPi * 0.0313 * ToSeconds(r.time)); };
  const auto wander = [](const Reading& r) { return 1e-4 * std::cos(2.0 * units::kPi * r.reading / 575.0); };
  const auto one_pass = [](const Reading& r) { return r.pass == 1 ? 1e-4 * std::cos(r.reference_rad) : 0.0; };
  const auto growing = [](const Reading& r) { return 1e-7 * r.reading * std::cos(5.0 * r.reference_rad); };
  const auto with_speed = [](const Reading& r) {
    return 1e-4 * r.velocity_rad_s * std::sin(4.0 * r.reference_rad);
  };
  const char* map_words =
      ".*direction times order 3 synchronous with reference angle, odd in direction, on angle, amplitude 0.0057 deg.*";
  const Structure structures[] = {
      // The next grid point is at most 0.025 away: 0.3 rad of phase at the ends of two turns.
      {"stops", "line", [](const Reading& r) { return 1e-4 * std::cos(4.508 * r.reference_rad); }, 0.15,
       "line at 4[.](49|50|51|52)[0-9] per turn synchronous with reference angle, .*deg"},
      {"stops", "direction harmonic", direction_map, 1e-6, map_words},
      {"sweep", "direction harmonic", direction_map, 1e-6, map_words},
      // Up to a quarter of the resolution away; the engine refines it.
      {"stops", "tone", tone, 0.5, ".*Hz, function of time.*"},
      {"stops", "wander", wander, 0.01, ".*"},
      // As that of a wave of its rms.
      {"stops", "pass", [](const Reading& r) { return r.pass % 2 == 0 ? 1e-4 : -1e-4; }, 1e-6, ".*amplitude 0.0081 deg"},
      {"stops", "pass harmonic", one_pass, 1e-6, ".*"},
      {"stops", "growing harmonic", growing, 1e-6, ".*"},
      {"sweep", "speed", [](const Reading& r) { return 1e-4 * std::abs(r.velocity_rad_s); }, 1e-6, ".*"},
      {"sweep", "speed harmonic", with_speed, 1e-6, ".*"},
      {"sweep", "harmonic", [](const Reading& r) { return 1e-4 * std::cos(7.0 * r.reference_rad); }, 1e-3,
       ".*harmonic of order 7 synchronous with reference angle, same in both directions.*"}};
  for (const Structure& structure : structures) {
    const auto [left, words] = BestOfSort(RunWith(structure.kind, structure.signal), structure.sort);
    EXPECT_LT(left, structure.left) << structure.kind << " " << structure.sort;
    EXPECT_THAT(words, testing::MatchesRegex(structure.words));
  }
}

TEST(EncoderUnknown, TellsALineByItsOrderBetweenTheGridPoints) {
  const std::vector<Family> families = Families(RunWith("stops", [](const Reading&) { return 0.0; }), {});
  const auto line = std::ranges::find(families, "line", &Family::group);
  ASSERT_NE(line, families.end());
  EXPECT_THAT(line->describe(0, Eigen::VectorXd::Ones(line->map.cols()), Eigen::VectorXd::Constant(1, 3.456)), testing::StartsWith("line at 3.456 per turn"));
}

TEST(EncoderUnknown, FindsAHysteresisAlsoWithoutItsName) {
  for (const char* kind : {"stops", "sweep"}) {
    const Scenario scenario = EncoderScenario(kind);
    const auto hysteresis = test::EncoderEffect("hysteresis", {{"lag", 1e-5}, {"settles_over", 30.0 * deg}});
    const EncoderRun encoder = RunOf(test::ReadingsWith(scenario, hysteresis), scenario);
    const auto [left, words] = BestOfSort(encoder, "transition", {"hysteresis"});
    const double offset_alone = BestOfSort(encoder, "direction offset").first;
    // The first pass begins in the middle, not on the other side as all others do; the grid's ways differ by 1.49.
    EXPECT_LT(left, 0.5 * offset_alone) << kind;
    EXPECT_THAT(words, testing::MatchesRegex("offset, function of direction that is reached over .* deg behind each "
                                             "reversal, odd in direction, on angle, .*"));
  }
}

/// And friction, which only a drive has, where any device may show a reversal.
TEST(EncoderUnknown, CountsLessWhereACauseOfTheCatalogueHasTheSameShape) {
  for (const Family& family : Families(RunWith("sweep", [](const Reading&) { return 0.0; }))) {
    const bool same = family.effect == "harmonic" || family.effect == "step" ||
                      family.effect == "direction offset" || family.effect == "transition" || family.effect == "friction";
    const bool own = (family.kind == Kind::kNamed && !same) || family.effect == "line";
    EXPECT_TRUE(!own || family.prior_weight == 1.0) << family.effect;
    EXPECT_TRUE(!same || family.prior_weight < 1.0) << family.effect;
  }
}

TEST(EncoderUnknown, HasNoShapesInTimeNorLinesInOneTurn) {
  Scenario scenario = EncoderScenario("stops");
  EncoderOf(scenario).encoder_procedure.passes = {1};
  EncoderOf(scenario).encoder_procedure.turns = 1.0;
  const auto families = Families(RunOf(twinbench::test::RunEncoderTwin(scenario).readings, scenario));
  for (const char* name : {"wander", "tone", "growing harmonic", "direction harmonic", "backlash", "hysteresis"})
    EXPECT_FALSE(test::HasFamily(families, name)) << name;
  for (const char* name : {"eccentricity", "periodic", "scale", "drift"})
    EXPECT_TRUE(test::HasFamily(families, name)) << name;
  // In one turn whole orders imitate every line between them.
  EXPECT_FALSE(test::HasFamily(families, "line"));
}

TEST(EncoderUnknown, LooksForOrdersThatTheSpacingCanShowAlsoAboveHalfOfUnevenPositions) {
  // 493.15 positions a turn: 360 of them and 133 look alike, but are not. Of 480, 240 and more are lower ones.
  const auto largest_at = [](double step_deg) {
    std::vector<double> angle_deg(500);
    for (std::size_t i = 0; i < angle_deg.size(); ++i) angle_deg[i] = step_deg * static_cast<double>(i);
    return LargestOrder(Steps(angle_deg, std::vector<int>(angle_deg.size(), 1)));
  };
  EXPECT_EQ(largest_at(0.73), 720);
  EXPECT_EQ(largest_at(0.75), 239);
  // Stops every 5 deg: orders below 36. Readings every 0.96 deg at the lower speed: 187.
  EXPECT_EQ(LargestOrder(RunWith("stops", [](const Reading&) { return 0.0; }).context), 35);
  EXPECT_EQ(LargestOrder(RunWith("sweep", [](const Reading&) { return 0.0; }).context), 187);
}

}  // namespace
}  // namespace twinbench::diagnose::encoder
