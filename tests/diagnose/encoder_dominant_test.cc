#include <utility>

#include "tests/diagnose/encoder_record.h"
#include "twin/diagnose/engine/repeats.h"
#include "twin/model/motion.h"

namespace twinbench::diagnose::encoder {
namespace {

using namespace lab;
using testing::HasSubstr, testing::Not, testing::StartsWith;

// Recordings in which one thing dominates and something else is there too, by closed forms. What is named first
// must be what is largest, in its size, however flexible other shapes are.

/// Once round and the same back.
Course Round(int stops) { return {360.0 / stops, 360.0 / stops, stops, 2}; }
/// From zero on, there and back twice, a second a stop.
Course Twice(int stops, double step_deg) { return {0.0, step_deg, stops, 4, 1.0}; }

/// A place that shows more than the others.
Error Worn(double size_deg, double at_deg, double width_deg) {
  return [=](const Place& at) { return size_deg * std::exp(-0.5 * std::pow((at.deg - at_deg) / width_deg, 2)); };
}

std::vector<Check> Orders(const std::vector<Wave>& waves, double within_deg, std::vector<Check> more = {}) {
  for (const Wave& wave : waves) more.push_back(Order(wave.order, wave.size_deg, within_deg));
  return more;
}

/// A servo that follows what was commanded a while ago, at `most_deg_s` at the fastest, in steps of a tenth of a
/// reading's.
Record FollowedWithin(double most_deg_s, double late_s, unsigned seed) {
  const Swing swing{120.0, 3.0};
  const double step_s = 0.002;
  double at_deg = 0.0, at_s = 0.0;
  return Swung(swing, 0.0, 15.0, 10.0 * step_s, 0.02, seed, [&](double t_s) {
    for (; at_s < t_s - 0.5 * step_s; at_s += step_s) {
      const double way_deg = swing.At(std::max(0.0, at_s + step_s - late_s)) - at_deg;
      at_deg += std::clamp(way_deg, -most_deg_s * step_s, most_deg_s * step_s);
    }
    return at_deg;
  });
}

TEST_P(EncoderAnswer, IsOfWhatTheReadingsWereMadeOf) {
  for (const unsigned seed : Seeds(GetParam().seeds)) {
    const Answer answer = Ask(GetParam().record(seed));
    SCOPED_TRACE(fmt::format("seed {}: {}", seed, answer.Words()));
    for (const Check& check : GetParam().checks) check(answer);
  }
}

Rows DominantRows() {
  Rows rows;
  const std::vector<Wave> four = {{1, 0.3, 20.0}, {2, 0.1, 140.0}, {3, 0.04, -70.0}, {4, 0.03, 260.0}};
  for (const auto& [stops, noise_deg] : {std::pair{200, 0.015}, std::pair{72, 0.003}}) {
    // One mounting tells no eccentricity from an offset.
    rows.push_back(OfCourse(
        fmt::format("OrdersThatRepeatThereAndBackAreNoWander_{}", stops), Round(stops), noise_deg, Of(four),
        Orders(four, 4.0 * noise_deg / std::sqrt(stops), {Is(Verdict::kTie), HasUnnamed(false), kSilentAgain}),
        {1, 2, 3}));
  }
  std::vector<Wave> many = {{1, 0.3, 20.0}, {2, 0.2, 140.0}};
  for (int order = 5; order <= 16; ++order) many.push_back({order, 0.008, 47.0 * order * order});
  rows.push_back(OfCourse("AsManySmallOrdersAsThereAreAreInTheFile", Round(180), 0.005, Of(many),
                          Orders(many, 4.0 * 0.005 / std::sqrt(180), {kSilentAgain}), {7}));
  for (const double most_deg_s : {80.0, 95.0}) {  // the rest is no news
    const auto file_has_it = [](const Answer& a) {
      EXPECT_THAT(a.Again().unknown.signature, Not(HasSubstr("speed limit")));
    };
    rows.push_back({fmt::format("AServoThatIsCommandedFasterThanItCanGoHasASpeedLimit_{}", most_deg_s),
                    [=](unsigned seed) { return FollowedWithin(most_deg_s, 0.06, seed); },
                    {Is(Verdict::kUnknown), Says(StartsWith(fmt::format("speed limit of {}", most_deg_s))),
                     HasCauses(0), file_has_it},
                    {10}});
  }
  for (const double range_deg :
       {60.0, 270.0, 400.0, 900.0}) {  // a scale in one pass, whatever part of a turn that is
    rows.push_back(OfCourse(fmt::format("ASlopeOfASinglePassIsAScale_{}", range_deg), {0.0, range_deg / 39.0, 40},
                            0.0003, [=](const Place& at) { return 0.01 * at.deg / range_deg; },
                            {Named("scale", 0.5), Size("scale", "ratio", 0.01 / range_deg, 0.1 * 0.01 / range_deg)},
                            {31}));
  }
  return rows;
}
INSTANTIATE_TEST_SUITE_P(Dominant, EncoderAnswer, testing::ValuesIn(DominantRows()), NameOfRow);

const Swing kLateSwing{60.0, 2.0}, kLateTurn{360.0, 16.0};
const std::vector<Wave> kWorm = {{144, 0.0039, 293.0}, {288, 0.0011, 270.0}},
                        kWormOfMount = {{144, 0.00167, 20.0}, {288, 0.0007, 200.0}};

const Row kDominant[] = {
    // What is less than a ten-thousandth of the variance is left out; the second diagnosis is no keener.
    OfCourse("WhatTheFirstDiagnosisHadForNothingTheSecondHasToo", Round(360), 0.003,
             Of({{1, 1.0, 20.0}, {7, 0.006, 70.0}, {11, 0.005, -20.0}}), {Order(1, 1.0, 0.001), kSilentAgain}, {8}),
    OfCourse(
        "WhatHasNoNameStandsBesideWhatDominates", Round(200), 0.01,
        [](const Place& at) {
          return Sum({{1, 0.5, 5.0}, {2, 0.3, 150.0}}, at.deg) + (at.stop % 2 == 0 ? 0.1 : -0.1) * at.direction;
        },
        {Is(Verdict::kTie), HasUnnamed(true), Order(1, 0.5, 0.01), Order(2, 0.3, 0.01)}, {4}),
    OfCourse("CoggingThatShiftsWithTheDirectionIsAnOrderAndItsProductWithTheDirection", Round(720), 0.01,
             [](const Place& at) {
               return 0.1 * std::cos((72.0 * at.deg + (at.direction > 0 ? 0.0 : 90.0)) * units::deg);
             },
             {Order(72, 0.1 / std::sqrt(2.0), 0.003), Says(HasSubstr("direction times order 72")), kSilentAgain},
             {5}),
    // A dish that follows a satellite over its highest point: the azimuth is commanded 5 deg/s at most, for a moment, and reaches 4.7.
    {"ALimitThatIsReachedForAMomentIsASpeedLimit",
     [](unsigned seed) {
       Noise noise_deg(0.0005, seed);
       const auto asked_deg = [](double t_s) { return 60.0 * std::atan((t_s - 200.0) / 12.0); };
       double at_deg = asked_deg(0.0);
       return Chirped(0.0, 399.9, 0.2, asked_deg, [&](double t_s) {
         at_deg += std::min(asked_deg(t_s) - at_deg, 4.7 * 0.2);
         return at_deg + noise_deg();
       });
     },
     {Is(Verdict::kUnknown), Says(StartsWith("speed limit of 4.7")), HasCauses(0)},
     {3}},
    {"AServoIsLateAndErrsByItsAcceleration",  // measured(t) = r - tau v - kappa a of r = R / 2 (1 - cos w t)
     [](unsigned seed) {
       const double w = 2.0 * units::kPi / kLateSwing.period_s;
       return Swung(kLateSwing, 0.0, 12.0, 0.01, 0.02, seed, [&](double t_s) {
         const double half_deg = 0.5 * kLateSwing.range_deg;
         return kLateSwing.At(t_s) - 0.004 * half_deg * w * std::sin(w * t_s) -
                0.0004 * half_deg * w * w * std::cos(w * t_s);
       });
     },
     {Named("latency"), Size("latency", "delay", 0.004, 0.02 * 0.004)},
     {6}},
    // The offset stays out of one reading inside the gap.
    OfCourse(
        "AnOffsetOfEachPassTakesNothingOfAReversalBesideAHighOrder", Round(400), 0.01,
        [](const Place& at) {
          const bool is_first_back = at.direction < 0 && at.stop == 399;
          return Sum({{1, 0.2, 10.0}, {50, 0.15, 60.0}}, at.deg) + (is_first_back ? 0.0 : -0.06 * at.direction);
        },
        {Order(50, 0.15, 0.004), Size("backlash", "width", 0.12, 0.0, 4.0)}, {13}),
    {"PlayIsFoundAtTargetsThatAreNotMetExactly",  // but to a part of a step: the first place behind a reversal is
                                                  // not quite the last one
     [](unsigned seed) {
       Noise noise_deg(0.004, seed), off_deg(0.02, seed + 1);
       Record record = Listed({-60.0, 1.0, 120, 4, 1.0}, [](const Place& at) { return at.deg; });
       for (Reading& r : record.readings) {
         const double at_deg = r.measured_rad / units::deg + off_deg();
         r.reference_rad = at_deg * units::deg;
         r.measured_rad =
             (1.001 * at_deg - 0.03 * r.direction + Sum({{45, 0.03, 0.0}}, at_deg) + noise_deg()) * units::deg;
       }
       return record;
     },
     {Size("backlash", "width", 0.06, 0.0, 4.0), Size("scale", "ratio", 0.001, 0.0, 4.0)},
     {14}},
    OfCourse("AScaleBesideAnOrderOfAPartOfATurnDoesNotBend", Twice(181, 1.5), 0.1,
             Of({{1, 0.5, 200.0}}) + [](const Place& at) { return 0.008 * at.deg; },
             {Size("scale", "ratio", 0.008, 0.0, 4.0), Order(1, 0.5, 0.05)}, {15, 16, 17}),
    {"ADelayOfATriangleIsNoPlay",  // it jumps where the shaft turns, as play does that is crossed at once
     [](unsigned seed) {
       Noise noise_deg(0.05, seed);
       const auto shaft_deg = [](double t_s) { return 30.0 - std::abs(std::remainder(30.0 * t_s, 120.0)); };
       return Chirped(1.003, 17.0, 0.01, shaft_deg,
                      [&](double t_s) { return 0.96 * shaft_deg(t_s - 0.06) + noise_deg(); });
     },
     {Named("latency"), Size("latency", "delay", 0.06, 0.05 * 0.06), NotNamed({"backlash"}, 0.0)},
     {18}},
    {"TheNoiseOfAReferenceThatMovesIsNoAcceleration",
     [](unsigned seed) {
       Noise noise_deg(0.003, seed);
       Record record = Listed({-90.0, 0.2, 900, 2, 0.02, "sweep"}, [](const Place& at) {
         return at.deg + Sum({{200, 0.014, 0.0}}, at.deg);
       });
       for (Reading& r : record.readings) r.reference_rad += noise_deg() * units::deg;
       return record;
     },
     {Order(200, 0.014, 0.0005), HasUnnamed(false)},
     {19}},
    OfCourse("AFaultOfAFewPlacesLeavesTheOrdersBesideIt", Twice(360, 1.0), 0.008,
             Of({{1, 0.06, 30.0}}) + Worn(0.4, 137.0, 1.2),
             {Order(1, 0.06, 0.002), Says(HasSubstr("targets"))}, {20}),
    {"ALatencyAndTheOrdersBesideItHaveTheirSizes",
     [](unsigned seed) {
       return Swung(kLateTurn, 0.0, 16.0, 0.01, 0.01, seed, [](double t_s) {
         const double shaft_deg = kLateTurn.At(t_s - 0.035);
         return shaft_deg + Sum({{1, 0.4, 190.0}, {2, 0.4, 60.0}, {4, 0.12, 235.0}}, shaft_deg);
       });
     },
     {Named("latency"), Size("latency", "delay", 0.035, 0.02 * 0.035), Order(1, 0.4, 0.02), Order(2, 0.4, 0.02),
      Order(4, 0.12, 0.006)},
     {7}},
    {"AServoThatIsCommandedAsItCanGoIsLate",
     [](unsigned seed) { return FollowedWithin(1000.0, 0.06, seed); },
     {Named("latency"), Size("latency", "delay", 0.06, 0.001)},
     {10}},
    OfCourse("OnePlacePushedFromBothSidesShowsThePlay", {30.0, 0.0, 1, 20, 1.0}, 0.001, ByDirection(-0.005),
             {Named("backlash", 0.5), Size("backlash", "width", 0.01, 0.0, 4.0), kSilentAgain}, {8}),
    // The straight line through a parabola has its slope in the middle, at 116 deg.
    OfCourse("WithoutAClockAScaleThatBendsIsNoDrift", {0.0, 8.0, 30}, 0.001,
             [](const Place& at) { return 0.001 * at.deg * (1.0 + 0.8 * at.deg / 360.0); },
             {Found("scale", "ratio", 0.001, 1e-4), Found("scale", "curvature", 0.8, 0.1), NotNamed({"drift"}, 0.0),
              Notes("scale: 0.0015"), kSilentAgain},
             {9}),
    {"ACourseInTimeThatDoesNotRepeatIsNoOrder",
     [](unsigned seed) {
       return Stops(0.001, 0.0, seed, [](const Place& at) {
         return 0.02 * std::sin(0.0127 * at.t_s) + 0.01 * std::cos(0.031 * at.t_s + 1.0);
       });
     },
     {NotNamed({"periodic"}, 0.5), NotNamed({"eccentricity", "ellipticity"}, 0.3), Is(Verdict::kUnknown)},
     {22}},
    // What a scale off its axis shows there is a line and a small bend, too.
    OfCourse("AQuarterOfATurnLeavesOpenWhetherItIsOrderOne", Twice(181, 0.5), 0.004,
             Of({{1, 0.2, 90.0}, {24, 0.05, 0.0}}),
             {Is(Verdict::kTie), Notes("once per turn (eccentricity) of 0.2")}, {61}),
    // A place that is dirty, a fifth of a turn wide: the other targets lie on the orders that are there.
    OfCourse("AWornPlaceLeavesTheOrdersBesideIt", Twice(121, 3.0), 0.002,
             Of({{1, 0.05, 327.0}, {4, 0.02, 270.0}}) + Worn(0.03, 180.0, 20.0) + ByDirection(0.01),
             {Order(1, 0.05, 0.004), Order(4, 0.02, 0.001), Play(0.02, 0.001)}, {51, 52, 53}),
    // A rack with a ripple and an arch: nothing of it is a course in time.
    OfCourse("OnePassWithoutAClockIsNoWalk", {0.0, 4.5, 76}, 0.005,
             [](const Place& at) {
               return 0.3 * at.deg / 360.0 * (1.0 - 2.0 * at.deg / 360.0) + Sum({{9, 0.02, 0.0}}, at.deg);
             },
             {Named("scale"), Order(9, 0.02, 0.004), Says(Not(HasSubstr("function of time")))}, {5}),
    // Explaining as much as each other, they are two causes, and no two names of one.
    OfCourse("AnOrderAndPlayOfOneSizeAreBothThere", Twice(36, 10.0), 1e-4,
             Of({{1, 0.0035, 0.0}, {4, 0.00085, 0.0}}) + ByDirection(0.0006),
             {Named("periodic"), Named("backlash"), Play(0.0012, 1e-4), HasUnnamed(false)}, {6}),
    OfCourse("AnOrderBesideASlopeIsAskedAgain", {0.0, 15.0 / 900.0, 900}, 0.0002,
             [](const Place& at) { return Sum(kWorm, at.deg) - 0.00053 * at.deg; }, Orders(kWorm, 0.0001),
             {1, 2, 3}),
    // The worm of a mount, seen over a thirtieth of a turn beside a drift: orders next to each other are hardly
    // told apart.
    OfCourse("AnOrderOfAPartOfATurnIsOneAndTheRightOne", {41.2, 6.0 * 15.041 / 3600.0, 500, 1, 6.0, "sweep"},
             0.0002, [](const Place& at) { return Sum(kWormOfMount, at.deg) - 0.0042 / 3600.0 * at.t_s; },
             {Order(144, 0.00167, 0.00006),
              [](const Answer& a) {
                const auto is_order = [](const Cause& cause) {
                  return cause.effect == "periodic" && cause.probability >= 0.5;
                };
                EXPECT_EQ(std::ranges::count_if(a.run.diagnosis.causes, is_order), 2);
              }},
             {22, 23, 24}),
    {"CoarseStepsThatEveryPassRepeatsAreNoCause",
     [](unsigned) {
       constexpr double kStep_deg = 360.0 / 4096.0, kPrint_deg = 1e-4;
       return Listed(Twice(180, 2.0), [&](const Place& at) {
         return std::round(std::round((at.deg + 0.137) / kStep_deg) * kStep_deg / kPrint_deg) * kPrint_deg;
       });
     },
     {Is(Verdict::kNone)}},
    // The second time with the device still on the old side.
    OfCourse("PlayIsFoundWhereTheTurningPointIsReadTwice", {0.0, 5.0, 60, 4, 60.0}, 0.0005,
             [](const Place& at) {
               const bool is_again = at.pass > 0 && at.stop == (at.direction > 0 ? 0 : 59);
               return 0.0001 * at.deg + 5e-7 * at.t_s - 0.006 * (is_again ? -at.direction : at.direction);
             },
             {Found("backlash", "width", 0.012, 0.001), kSilentAgain}, {21})};
INSTANTIATE_TEST_SUITE_P(Dominated, EncoderAnswer, testing::ValuesIn(kDominant), NameOfRow);

TEST(Repeats, PlacesAreTargetsOrBinsAndOnePassHasNone) {
  Eigen::VectorXd there_and_back(40), once = Eigen::VectorXd::LinSpaced(40, 0.0, 6.0);
  for (int k = 0; k < 40; ++k) there_and_back[k] = 0.1 * (k < 20 ? k : 39 - k);
  const std::vector<int> one(40, 0);
  EXPECT_TRUE(PlacesOf(once, one).empty());
  const std::vector<int> place = PlacesOf(there_and_back, one);
  ASSERT_EQ(place.size(), 40u);
  EXPECT_EQ(place[3], place[36]);
  EXPECT_NE(place[3], place[4]);
  std::vector<int> two(40, 0);
  std::fill(two.begin() + 20, two.end(), 1);
  EXPECT_TRUE(PlacesOf(there_and_back, two).empty()) << "another mounting is another place";
}

TEST(Repeats, WhatIsTheSameAtEveryVisitIsNotCounted) {
  std::vector<int> place;
  Eigen::VectorXd same(40), opposite(40);
  for (int k = 0; k < 40; ++k) {
    place.push_back(k < 20 ? k : 39 - k);
    same[k] = std::cos(place.back());
    opposite[k] = k < 20 ? 1.0 : -1.0;
  }
  EXPECT_NEAR(PowerNotRepeating(place, same), 0.0, 1e-12);
  // Every reading differs by one from the mean of its place; 39 visits of 20 places, the two at the turn being one.
  EXPECT_NEAR(PowerNotRepeating(place, opposite), 40.0 * 39.0 / 19.0, 1e-9);
}

TEST(SteadyCourse, SmoothsNoiseAndNeitherCornersNorAMotionWithoutNoise) {
  constexpr int kReadings = 1000;
  Noise noise(0.05, 3);
  model::Course course;
  course.reading.resize(kReadings);
  course.setup.assign(kReadings, 0);
  course.pass.assign(kReadings, 0);
  course.time_s = Eigen::VectorXd::LinSpaced(kReadings, 0.0, 0.001 * (kReadings - 1));
  const Eigen::ArrayXd t = course.time_s;
  const Eigen::VectorXd true_deg = 200.0 * (t - 0.5).abs(),
                        noisy_deg = true_deg + true_deg.unaryExpr([&](double) { return noise(); });
  EXPECT_FALSE(model::SteadyCourseOf(course, true_deg).is_smoothed);
  const model::SteadyCourse steady = model::SteadyCourseOf(course, noisy_deg);
  ASSERT_TRUE(steady.is_smoothed);
  const Eigen::ArrayXd speed_deg_s = (t < 0.5).select(Eigen::ArrayXd::Constant(kReadings, -200.0), 200.0);
  const auto rms = [](const Eigen::ArrayXd& x) { return std::sqrt(x.square().mean()); };
  EXPECT_LT(rms((steady.rate.array() - speed_deg_s).segment(40, 400)), 0.02 * 200.0);
  EXPECT_GT(rms((model::RateOfChange(course, noisy_deg).array() - speed_deg_s).segment(40, 400)), 0.1 * 200.0);
  EXPECT_LT((steady.values - true_deg).segment(480, 40).cwiseAbs().maxCoeff(), 5.0 * 0.05) << "the corner";
}

TEST(RateOfChange, IsExactForAParabolaWithUnevenStepsAlsoWhereItTurnsBack) {
  model::Course course;
  Eigen::VectorXd t(9), y(9), slope(9);
  t << 0.0, 0.1, 0.25, 0.3, 0.4, 0.55, 0.6, 0.7, 5.0;
  for (int k = 0; k < 9; ++k) {
    course.reading.push_back(k);
    course.setup.push_back(0);
    course.pass.push_back(t[k] < 0.35 ? 0 : 1);
    y[k] = std::pow(t[k] - 0.35, 2);
    slope[k] = 2.0 * (t[k] - 0.35);
  }
  course.time_s = t;
  const Eigen::VectorXd rate = model::RateOfChange(course, y);
  EXPECT_NEAR((rate - slope).head(8).cwiseAbs().maxCoeff(), 0.0, 1e-12);
  EXPECT_EQ(rate[8], 0.0) << "after a pause there is no neighbour";
}

}  // namespace
}  // namespace twinbench::diagnose::encoder
