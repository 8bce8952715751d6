#include "tests/separate/encoder_readings.h"
#include "tests/support/kept_text.h"
#include "tests/support/over_seeds.h"
#include "tests/support/night.h"
#include "twin/benches/encoder_comparison/estimators/device_error.h"
#include "twin/benches/encoder_comparison/estimators/iso230_2.h"
#include "twin/core/errors.h"
#include "twin/core/rounding.h"
#include "twin/core/scenario.h"

namespace twinbench::separate::encoder {
namespace {

using testing::Contains, testing::HasSubstr;
using test::Comparison, test::ValueOf, test::Wave;
using units::arcsec, units::deg;

const std::vector<Wave> kDevice = {{1, 900.0, 0.7}, {2, 400.0, -1.2}, {7, 60.0, 2.0}, {12, 20.0, 0.3}};
const std::vector<Wave> kReference = {{1, 70.0, 1.3}, {3, 25.0, -0.4}, {12, 9.0, 2.2}};

/// Largest difference to a closed form at every degree [arcsec].
double Worst_arcsec(const harmonics::HarmonicSeries& series, const std::vector<Wave>& waves) {
  const Eigen::VectorXd value_rad = Curve(series, 360).value_rad;
  double worst = 0.0;
  for (int i = 0; i < 360; ++i) worst = std::max(worst, std::abs(value_rad[i] - ValueOf(waves, i * deg)));
  return worst / arcsec;
}

// Without noise only rounding is left: 1e-12 rad of angles up to 15 rad in normal equations is 1e-6 arcsec.
constexpr double kRounding_arcsec = 1e-5;

TEST(SeparateDevice, GivesBackAKnownCurveFromStopsOfAnyKind) {
  Comparison bench{.device = kDevice};
  const DeviceError even = SeparateDevice(bench.Readings());
  EXPECT_LT(Worst_arcsec(even.curves.device, kDevice), kRounding_arcsec);
  EXPECT_EQ(even.highest_order, 35) << "(72 - 1) / 2";
  bench.jitter_rad = [](int k) { return 1.2 * deg * std::sin(1.7 * k); };
  bench.missing = [](int i) { return i % 11 == 3; };
  const DeviceError uneven = SeparateDevice(bench.Readings());
  EXPECT_LT(Worst_arcsec(uneven.curves.device, kDevice), kRounding_arcsec);
  EXPECT_EQ(uneven.left_out, 53) << "every 11th of 4 x 144";
  EXPECT_EQ(uneven.used, 523);
}

TEST(SeparateDevice, FollowsDeviceAndReferenceThatWrapAtATurn) {
  const Comparison bench{.device = kDevice};
  std::vector<Reading> readings = bench.Readings();
  for (Reading& r : readings) {
    for (double* angle_rad : {&r.measured_rad, &r.reference_rad}) *angle_rad -= units::turn * std::floor(*angle_rad / units::turn);
  }
  const DeviceError wrapped = SeparateDevice(readings);
  EXPECT_LT(Worst_arcsec(wrapped.curves.device, kDevice), kRounding_arcsec);
  EXPECT_NEAR(wrapped.passes.front().turns, 2.0, 0.05) << "one stop short of two turns";
}

TEST(SeparateDevice, CountsTheReferencesErrorAsTheDevicesWithOneMounting) {
  const Comparison bench{.device = kDevice, .reference = {{3, 25.0, -0.4}}};
  const DeviceError e = SeparateDevice(bench.Readings());
  EXPECT_TRUE(e.curves.reference.orders.empty());
  EXPECT_EQ(static_cast<int>(e.curves.lost.size()), e.highest_order);
  std::vector<Wave> difference = kDevice;
  difference.push_back({3, -25.0, -0.4});
  // The reference is read off by 25 arcsec: times the device's slope 0.0065 that is 0.17 arcsec.
  EXPECT_LT(Worst_arcsec(e.curves.device, difference), 0.5);
}

TEST(SeparateDevice, TellsDeviceFromReferenceByThreeMountings) {
  const Comparison bench{
      .device = kDevice, .reference = kReference, .mounting_rad = {0.0, 120.0 * deg, 215.0 * deg}};
  const DeviceError e = SeparateDevice(bench.Readings());
  EXPECT_TRUE(e.curves.lost.empty()) << "215 deg is a whole number of periods with 120 deg only from order 72 on";
  EXPECT_LT(Worst_arcsec(e.curves.device, kDevice), 0.001)
      << "rounds of the reference's error: 70 arcsec x 0.0065^4";
  EXPECT_LT(Worst_arcsec(e.curves.reference, kReference), 0.1)
      << "it follows its reading, off by its error: 70^2 arcsec^2";
  EXPECT_NEAR(e.mounting_rad[1], 120.0 * deg, 1e-9);
}

TEST(SeparateDevice, CannotTellEvenOrdersApartByOppositeMountings) {
  const Comparison bench{.device = {{1, 100.0, 0.7}, {2, 50.0, 0.0}},
                         .reference = {{1, 70.0, 1.3}, {2, 20.0, 0.0}},
                         .mounting_rad = {0.0, 180.0 * deg}};
  const DeviceError e = SeparateDevice(bench.Readings());
  ASSERT_EQ(e.curves.lost.size(), 17u) << "the even ones up to 35";
  for (const int order : e.curves.lost) EXPECT_EQ(order % 2, 0);
  // Second order: error x slope, 100 arcsec x 5e-4.
  EXPECT_NEAR(harmonics::Amplitude(e.curves.device.At(1)) / arcsec, 100.0, 0.1);
  EXPECT_NEAR(harmonics::Amplitude(e.curves.reference.At(1)) / arcsec, 70.0, 0.1);
  EXPECT_NEAR(harmonics::Amplitude(e.curves.device.At(2)) / arcsec, 50.0 - 20.0, 0.1) << "the difference";
  EXPECT_TRUE(std::isnan(e.curves.reference.At(2).value.real()));
}

TEST(SeparateDevice, GivesTheReversalAsMeanAndCurve) {
  const Comparison bench{.device = kDevice, .backward = {{2, 30.0, 0.5}}, .reversal_arcsec = -85.0};
  const DeviceError e = SeparateDevice(bench.Readings());
  EXPECT_NEAR(e.reversal.value_rad / arcsec, -85.0, kRounding_arcsec);
  EXPECT_LT(Worst_arcsec(e.curves.reversal, {{2, -30.0, 0.5}}), kRounding_arcsec);
  EXPECT_LT(Worst_arcsec(e.curves.forward, kDevice), kRounding_arcsec);
  std::vector<Wave> mean = kDevice;
  mean.push_back({2, 15.0, 0.5});
  EXPECT_LT(Worst_arcsec(e.curves.device, mean), kRounding_arcsec);
}

TEST(SeparateDevice, GivesMeansByDegreesThatHaveAllOrders) {
  // Order 36 alternates at 72 stops and is above the highest order.
  const Comparison bench{.device = {{1, 300.0, 0.0}, {36, 10.0, -36 * 0.02}}, .backward = {{2, 30.0, 0.5}}};
  const DeviceError e = SeparateDevice(bench.Readings());
  // Over 144 stops the signs are not quite orthogonal to a slope: 72 / (144^3 / 12) a stop, 0.021 of them at the
  // ends.
  const double slope_rad = 0.021 * 10.0 * arcsec;
  ASSERT_EQ(e.forward.count.size(), 72u);
  for (std::size_t i = 0; i < 72; ++i) {
    EXPECT_EQ(e.both.count[i], 8);
    EXPECT_EQ(e.forward.count[i], 4);
    const double angle_rad = e.forward.position_rad[i];
    EXPECT_NEAR(angle_rad, 0.02 + static_cast<double>(i) * 5.0 * deg, 1e-9);
    EXPECT_NEAR(e.forward.value_rad[i], ValueOf(bench.device, angle_rad), slope_rad);
    EXPECT_NEAR(e.forward.u_rad[i], 0.0, slope_rad) << "all four are alike";
    EXPECT_NEAR(e.both.value_rad[i], ValueOf(bench.device, angle_rad) + 0.5 * ValueOf(bench.backward, angle_rad),
                slope_rad);
  }
}

TEST(SeparateDevice, TakesSteadyDriftForSlopesOfThePassesNotForTheCurve) {
  Comparison bench{.device = kDevice};
  bench.drift_arcsec = [](int i, int) { return 0.5 * i; };
  const DeviceError e = SeparateDevice(bench.Readings());
  EXPECT_LT(Worst_arcsec(e.curves.device, kDevice), 1.7)
      << "the zero, and with it the mounting, is off by 144 arcsec in the mean, the curve's steepest slope is "
         "0.0114";
  ASSERT_EQ(e.passes.size(), 4u);
  for (const PassResult& pass : e.passes)
    EXPECT_NEAR(pass.slope_rad_per_turn / arcsec, pass.direction * 36.0, 1e-3) << "72 readings a turn";
  EXPECT_NEAR(e.reversal.value_rad / arcsec, 0.0, kRounding_arcsec) << "+ - - + has the same mean time both ways";
}

TEST(SeparateDevice, SaysThatOneTurnDoesNotTellDriftFromTheCurve) {
  const DeviceError e = SeparateDevice(Comparison{.device = kDevice, .turns = 1.0}.Readings());
  EXPECT_THAT(e.notes, Contains(HasSubstr("does not tell drift")));
  EXPECT_TRUE(std::isnan(e.passes.front().slope_rad_per_turn));
  EXPECT_LT(Worst_arcsec(e.curves.device, kDevice), kRounding_arcsec);
}

TEST(SeparateDevice, HasNoCurveFromAPartOfATurn) {
  const DeviceError e = SeparateDevice(Comparison{.device = kDevice, .turns = 0.5}.Readings());
  EXPECT_EQ(e.highest_order, 0);
  EXPECT_KEPT(e.not_separated);
  EXPECT_KEPT(SeparateDevice({}).not_separated);
}

TEST(SeparateDevice, SaysThatTheDeviceCountsTheOtherWayOrThroughAGear) {
  std::vector<Reading> readings = Comparison{.device = kDevice}.Readings();
  for (const double factor : {-1.0, 4.0}) {
    std::vector<Reading> geared = readings;
    for (Reading& r : geared) r.measured_rad *= factor;
    EXPECT_KEPT(SeparateDevice(geared).not_separated);
  }
}

TEST(SeparateDevice, LeavesOutASetUpThatWasBrokenOff) {
  Comparison bench{.device = kDevice, .mounting_rad = {0.0, 100.0 * deg}};
  bench.missing = [](int i) { return i > 576 + 40; };
  const DeviceError e = SeparateDevice(bench.Readings());
  EXPECT_EQ(e.mounting_rad.size(), 1u);
  EXPECT_THAT(e.notes, Contains(HasSubstr("mounting 1, direction +1: too small a part of the turn")));
  EXPECT_LT(Worst_arcsec(e.curves.device, kDevice), kRounding_arcsec);
}

TEST(SeparateDevice, FindsADelayFromChangesOfTheSpeed) {
  Comparison bench{.device = kDevice, .stops = 360, .turns = 4.0};
  std::vector<Reading> readings = bench.Readings();
  for (Reading& r : readings) {
    r.velocity_rad_s = r.direction * (20.0 + 10.0 * std::sin(0.011 * r.reading)) * deg;
    r.measured_rad -= r.velocity_rad_s * 0.003;
  }
  const DeviceError e = SeparateDevice(readings);
  EXPECT_NEAR(e.lag_s, 0.003, 1e-9);
  // The mean speeds of both directions differ by 0.1 deg/s: half of it x delay is the mounting's error, x slope
  // 0.0114.
  EXPECT_LT(Worst_arcsec(e.curves.device, kDevice), 0.01);
}

TEST(SeparateDevice, WidensTheUncertaintyOfAnOrderThatChangedWithTheMounting) {
  // Seated anew, the device has another eccentricity: 30 arcsec more, where noise leaves 0.6 arcsec.
  Comparison bench{.device = kDevice, .mounting_rad = {0.0, 100.0 * deg, 215.0 * deg}, .noise_arcsec = 7.0};
  const double before = SeparateDevice(bench.Readings()).curves.device.At(1).cov(0, 0);
  bench.drift_arcsec = [](int i, int setup) {
    return setup == 2 ? 30.0 * std::cos(2.0 * units::kPi * (i % 144) / 72.0) : 0.0;
  };
  bench.passes = {1, 1, 1, 1};
  const DeviceError e = SeparateDevice(bench.Readings());
  EXPECT_THAT(e.notes, Contains(HasSubstr("contradict each other in order 1:")));
  EXPECT_EQ(e.curves.disagreeing, std::vector{1});
  EXPECT_GT(e.curves.device.At(1).cov(0, 0), 100.0 * before) << "chi2 / dof is about (30 / 1)^2 / 2";
}

/// Means of (error / u)^2 over seeds, and over positions or orders of the curves; NaN: there is no such curve.
struct Coverage {
  double device, reference, first_order, reversal;
};

double MeanChi2(const harmonics::HarmonicSeries& series, const std::vector<test::Wave>& waves) {
  const CurveAt curve = Curve(series, 72);
  double sum = 0.0;
  for (int i = 0; i < 72; ++i)
    sum += std::pow((curve.value_rad[i] - ValueOf(waves, 5.0 * i * deg)) / curve.u_rad[i], 2) / 72.0;
  return sum;
}

/// @param draw  (seed): the device's waves of that seed.
template <class Draw>
Coverage CoverageOf(Comparison bench, int seeds, Draw draw) {
  const Eigen::Array4d mean = twinbench::test::MeanOverSeeds(seeds, [&](std::uint64_t seed) {
    bench.seed = seed;
    bench.device = draw(seed);
    const DeviceError e = SeparateDevice(bench.Readings());
    const bool has_reference = !e.curves.reference.orders.empty();
    return Eigen::Array4d(MeanChi2(e.curves.device, bench.device),
                          has_reference ? MeanChi2(e.curves.reference, bench.reference) : kNaN,
                          test::OrderChi2(e.curves.device, bench.device, 1),
                          std::pow(e.reversal.value_rad / e.reversal.u_rad, 2));
  });
  return {mean[0], mean[1], mean[2], mean[3]};
}

Coverage CoverageOf(const Comparison& bench) {
  return CoverageOf(bench, test::ByNight(200, 60), [device = bench.device](std::uint64_t) { return device; });
}

// Small errors, so that error x slope does not count: 5 arcsec x 5e-5.
const std::vector<test::Wave> kSmallDevice = {{1, 5.0, 0.4}, {5, 3.0, 1.0}}, kSmallReference = {{1, 4.0, -1.0}};

// Of 35 orders' chi-squared over 60 seeds the mean has a standard deviation of 0.03, one order's (2 parts) 0.13.
// The uncertainty is from 12 degrees of freedom for order 1 with one mounting: 1 / F has the mean 12 / 10 there.

TEST(SeparateDeviceUncertainty, CoversWhiteNoiseWithOneMountingWithThreeAndInASingleTurnByTheResidualsOfItsFit) {
  const Coverage one = CoverageOf({.device = kSmallDevice, .noise_arcsec = 7.0});
  const Coverage three = CoverageOf({.device = kSmallDevice, .reference = kSmallReference,
                                     .mounting_rad = {0.0, 100.0 * deg, 215.0 * deg}, .noise_arcsec = 7.0});
  const Coverage turn = CoverageOf({.device = kSmallDevice, .passes = {1, -1}, .turns = 1.0, .noise_arcsec = 7.0});
  for (const double found : {one.device, three.device, three.reference, turn.device}) EXPECT_NEAR(found, 1.0, 0.15);
  EXPECT_NEAR(one.first_order, 1.2, 0.35);
  // Pooled from two degrees of freedom, but never below the readings' noise.
  EXPECT_NEAR(one.reversal, 0.8, 0.4);
}

/// Of rings with random orders up to `highest`, which fall as 1 / order or do not.
Coverage CoverageOfRings(int rings, int highest, bool falls, const Comparison& bench) {
  return CoverageOf(bench, rings, [=](std::uint64_t seed) {
    Stream stream(seed, "test.ring");
    std::vector<Wave> ring;
    for (int k = 1; k <= highest; ++k)
      ring.push_back({k, 20.0 / (falls ? k : 1) * std::abs(stream.Normal()), units::turn * stream.Uniform()});
    return ring;
  });
}

Coverage CoverageOfFalling(int highest, const Comparison& bench) {
  return CoverageOfRings(20, highest, true, bench);
}

// Orders above half the stops fold into those below: without them in u the squares are some tens and hundreds. The
// few that count most make the mean over 20 rings uncertain by a fifth, and the level is found with the folded ones
// in it.
TEST(SeparateDeviceUncertainty, CoversOrdersThatTheStopsDoNotTell) {
  const Coverage folded = CoverageOfFalling(150, {.noise_arcsec = 0.05});
  EXPECT_NEAR(folded.device, 0.8, 0.5);
  const Coverage two = CoverageOfFalling(150, {.mounting_rad = {0.0, 122.0 * deg}, .noise_arcsec = 0.05});
  EXPECT_NEAR(two.device, 0.7, 0.6);
  EXPECT_NEAR(two.reference, 0.7, 0.6) << "what two mountings fold in different ways is no error of the reference";
  EXPECT_NEAR(CoverageOfFalling(150, {.passes = {1, -1}, .stops = 360, .noise_arcsec = 0.05}).device, 0.8, 0.5) << "orders above 64";
  // The stops tell orders up to 179, and the readings show none above 64.
  EXPECT_NEAR(CoverageOfFalling(64, {.passes = {1, -1}, .stops = 360, .noise_arcsec = 0.05}).device, 1.0, 0.15);
}

TEST(SweepsThatFitNoMemory, AreRefusedWhenTheScenarioIsRead) {
  const std::string sweep = "bench = \"encoder_comparison\"\n[encoder_procedure]\nkind = \"sweep\"\nspeeds_deg_s = ";
  EXPECT_THROW(ParseScenario(sweep + "[1e-4, 1e-4, 1e-4]\n", "slow.toml", ""), InputError);
  EXPECT_NO_THROW(ParseScenario(sweep + "[10.0, 30.0]\n", "usual.toml", ""));
}

/// A spectrum that has come to its end below half the stops is not taken to go on: u was fifteen times what there was.
TEST(SeparateDeviceUncertainty, EndsWhereTheLastOrdersAreNoiseAlone) {
  const double mean = CoverageOfRings(12, 28, false, {.noise_arcsec = 0.3}).device;
  EXPECT_GT(mean, 0.15);
  EXPECT_LT(mean, 1.5);
}

/// 72 stops show order 80 as order 8, and 144 not at all.
TEST(SeparateDeviceUncertainty, HoldsThatLinesMayBeTheOrderThatTheyLookLike) {
  const Comparison bench{.device = {{1, 5.0, 0.4}, {80, 3.0, 1.0}}, .noise_arcsec = 0.1};
  const DeviceError unknown = SeparateDevice(bench.Readings());
  const DeviceError known = SeparateDevice(bench.Readings(), {.of_lines = {80, 144}});
  EXPECT_GT(MeanChi2(unknown.curves.device, bench.device), 100.0);
  EXPECT_LT(MeanChi2(known.curves.device, bench.device), 4.0);
  EXPECT_THAT(known.notes, Contains(HasSubstr("lower ones: 80;")));
  EXPECT_THAT(known.notes, Contains(HasSubstr("no u: 144")));
}

TEST(SeparateDeviceUncertainty, CoversAZeroThatWandersFromReadingToReading) {
  // A random walk of 1 arcsec a reading beside white noise: 12 arcsec in two turns, mostly in the low orders.
  Comparison bench{.device = kSmallDevice, .noise_arcsec = 1.0};
  Stream stream(5, "test.walk");
  std::vector<double> walk;
  bench.drift_arcsec = [&](int i, int) {
    if (i == 0) walk.clear();
    walk.push_back((walk.empty() ? 0.0 : walk.back()) + stream.Normal());
    return walk.back();
  };
  const Coverage c = CoverageOf(bench);
  EXPECT_GT(c.device, 0.5);
  EXPECT_LT(c.device, 2.0);
  EXPECT_LT(c.first_order, 3.0) << "white noise alone would claim 30 times too little variance";
}

struct Steps {
  int bits, stops;
  double noise_arcsec;
  std::vector<double> mounting_deg;
};

std::vector<Reading> Rounded(std::vector<Reading> readings, double step_rad) {
  for (Reading& r : readings) r.measured_rad = step_rad * std::round(r.measured_rad / step_rad);
  return readings;
}

// What steps round alike at every visit of a place is in no scatter. It is known no better than within half a step, and
// by how the beat of stops and steps falls into few orders: (error / u)^2 of 1 within a factor of some.
TEST(SeparateDeviceUncertainty, HasAFloorByStepsThatRoundEveryPassAlike) {
  const std::vector<Steps> cases = {{12, 72, 0.3, {0.0}},  {13, 48, 0.3, {0.0}},         {14, 72, 20.0, {0.0}}, {16, 90, 0.3, {0.0}},
                                    {17, 36, 4.0, {0.0}},  {18, 72, 1.0, {0.0}},         {20, 60, 0.1, {0.0}},  {20, 72, 3.0, {0.0}},
                                    {14, 72, 0.3, {0, 100, 215}}, {16, 72, 0.3, {0, 33.3, 171.7}}};
  const int seeds = test::ByNight(30, 4);
  for (const Steps& c : cases) {
    SCOPED_TRACE(testing::Message() << c.bits << " bit, " << c.stops << " stops, " << c.noise_arcsec << " arcsec");
    const double step_rad = units::turn / std::pow(2.0, c.bits);
    double device = 0.0, largest = 0.0;
    Stream stream(7, "test.mounting");
    for (int seed = 0; seed < seeds; ++seed) {
      Comparison bench{.device = kSmallDevice, .stops = c.stops, .noise_arcsec = c.noise_arcsec, .seed = static_cast<std::uint64_t>(seed)};
      const double start_rad = units::turn * stream.Uniform();
      bench.mounting_rad.clear();
      for (const double at : c.mounting_deg) bench.mounting_rad.push_back(start_rad + at * deg);
      const DeviceError e = SeparateDevice(Rounded(bench.Readings(), step_rad), {.steps = {step_rad}});
      device += MeanChi2(e.curves.device, bench.device) / seeds;
      for (int k = 1; k <= e.curves.device.Highest(); ++k)
        largest = std::max(largest, test::OrderChi2(e.curves.device, bench.device, k));
    }
    EXPECT_GT(device, 0.2);
    EXPECT_LT(device, 4.0);
    EXPECT_LT(largest, 15.0) << "of thousands of orders";
    const DeviceError found = SeparateDevice(Rounded(Comparison{.device = kSmallDevice, .stops = c.stops}.Readings(), step_rad));
    EXPECT_GT(found.curves.device.At(1).cov.trace(), 1e-4 * step_rad * step_rad) << "the readings show their steps";
  }
}

TEST(Positioning, KnowsItsTargetsNoBetterThanInSteps) {
  Stream stream(11, "test.noise");
  for (const double noise : {0.02, 0.3, 1.0}) {  // of a step
    double mean = 0.0, reversal = 0.0;
    std::vector<measure::PositioningTarget> targets;
    for (int i = 0; i < 300; ++i) {
      measure::PositioningTarget target{i * 0.02, {}, {}};
      const double place = 10.0 * stream.Uniform();  // true deviation: less itself
      const auto shown = [&](double back) { return std::round(place + back + noise * stream.Normal()) - place; };
      for (int run = 0; run < 5; ++run) target.forward.push_back(shown(0.0)), target.backward.push_back(shown(0.37) - 0.37);
      targets.push_back(target);
    }
    const auto all = measure::EvaluatePositioning(targets, {.replicas = 0}, measure::RoundingOfTargets(targets, 1.0, 1.0));
    for (const auto& t : all.targets) {
      mean += std::pow(t.mean / t.u_mean, 2) / 300.0;
      reversal += std::pow(t.reversal / t.u_reversal, 2) / 300.0;
    }
    EXPECT_GT(std::min(mean, reversal), 0.3) << noise;
    EXPECT_LT(std::max(mean, reversal), 2.5) << noise;
  }
}

TEST(NoiseBehindRounding, IsWhatMakesRoundedReadingsScatterAsTheyDo) {
  for (const double noise : {0.1, 0.2, 0.35, 1.0}) {
    Stream stream(3, "test.noise");
    double squares = 0.0, repeated = 0.0;
    constexpr int kPlaces = 400, kVisits = 50;
    for (int place = 0; place < kPlaces; ++place) {
      const double at = stream.Uniform();
      double sum = 0.0, sum2 = 0.0;
      for (int k = 0; k < kVisits; ++k) {
        const double error = std::round(at + noise * stream.Normal()) - at;
        sum += error;
        sum2 += error * error;
      }
      squares += (sum2 - sum * sum / kVisits) / (kVisits - 1);
      repeated += std::pow(sum / kVisits, 2) / kPlaces;
    }
    const double scatter2 = squares / kPlaces;
    // Of 20 000 readings 1 %; the mean of 50 has a fiftieth of their scatter besides what repeats.
    EXPECT_NEAR(NoiseBehindRounding(1.0, std::sqrt(scatter2)), noise, 0.03 * std::max(noise, 0.3)) << noise;
    EXPECT_NEAR(RoundingOf(1.0, noise, kVisits).repeated, repeated - scatter2 / kVisits, 0.006) << noise;
    const Eigen::MatrixXd waves = RoundingWaves(Eigen::Vector2d(0.3, 5.3), 1.0, noise);
    EXPECT_NEAR(waves.row(0).dot(waves.row(1)), RepeatedByRounding(noise), 1e-12) << "whole steps apart";
  }
  EXPECT_EQ(NoiseBehindRounding(1.0, 0.0), 0.0);
}

TEST(CommonStep, IsFoundBehindADecimalPrint) {
  constexpr double kStep = 360.0 / 4096.0, kPrint = 1e-4;
  Eigen::VectorXd rounded(720), any(720), ten_digits(720);
  for (Eigen::Index i = 0; i < rounded.size(); ++i) {
    const double value = 0.5 * static_cast<double>(i) + 0.137;
    rounded[i] = std::round(std::round(value / kStep) * kStep / kPrint) * kPrint;
    const double step = std::round(value / kStep) * kStep, digit = std::pow(10.0, std::floor(std::log10(step)) - 9.0);
    ten_digits[i] = std::round(step / digit) * digit;
    any[i] = std::round((value + 0.2 * std::sin(static_cast<double>(i * i))) / kPrint) * kPrint;
  }
  EXPECT_NEAR(CommonStep(rounded), kStep, 1e-3 * kStep);
  EXPECT_NEAR(CommonStep(ten_digits), kStep, 1e-5 * kStep) << "whose last one goes with the size of the value";
  EXPECT_NEAR(CommonStep(any), kPrint, 1e-9) << "no coarser one";
  Eigen::VectorXd evenly(120);
  for (Eigen::Index i = 0; i < evenly.size(); ++i) evenly[i] = std::round(3.0 * static_cast<double>(i) / kStep) * kStep;
  EXPECT_NEAR(CommonStep(evenly), kStep, 1e-9) << "and no wider one where the positions are";
}

}  // namespace
}  // namespace twinbench::separate::encoder
