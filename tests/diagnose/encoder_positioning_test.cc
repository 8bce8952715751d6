#include <random>

#include "tests/diagnose/encoder_record.h"
#include "tests/support/over_seeds.h"
#include "twin/benches/encoder_comparison/diagnosis/memory.h"

namespace twinbench::diagnose::encoder {
namespace {

using namespace lab;
using testing::HasSubstr, testing::Not, testing::StartsWith;

// Recordings whose noise remembers what it was.

/// Six seconds of a motor that swings once a second, and a tilt sensor that is late, shows too little and whose
/// noise rings: x_k = 1.2 x_(k-1) - 0.6 x_(k-2) + e_k.
Record LateAndShort(double late_s, double scale, double noise_deg, unsigned seed) {
  const Swing swing{36.0, 1.0, -18.0};
  Noise step_deg(noise_deg * std::sqrt(0.28), seed);
  double last_deg = 0.0, before_deg = 0.0;
  return Swung(swing, 0.0, 6.0, 0.002, 1e-6, seed, [&](double t_s) {
    before_deg = std::exchange(last_deg, 1.2 * last_deg - 0.6 * before_deg + step_deg());
    return (1.0 + scale) * swing.At(t_s - late_s) + last_deg;
  });
}

/// A walk of steps of `step_deg` beside noise.
Record Walked(const Course& course, double step_deg, double noise_deg, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> step(0.0, step_deg), noise(0.0, noise_deg);
  double walk_deg = 0.0;
  return Listed(course, [&](const Place& at) {
    walk_deg += step(random);
    return at.deg + walk_deg + noise(random);
  });
}

const Row kMemory[] = {
    {"ALagAndAScaleAreNoLoopThatFollowsBoth",
     [](unsigned seed) { return LateAndShort(0.0114, -0.05, 0.1, seed); },
     {Named("latency"), Named("scale"), NotNamed({"hysteresis", "backlash"}, 0.5),
      // Its velocity is that of what it shows: a twentieth less.
      Size("latency", "delay", 0.95 * 0.0114, 0.02 * 0.0114), Size("scale", "ratio", -0.05, 0.02 * 0.05)},
     {1, 2, 3}},
    {"ARandomWalkIsNoDriftAndNoScale",
     [](unsigned seed) {
       return Walked({0.0, 2.0, 900, 1, 0.5, "sweep"}, 0.001, 0.0015, seed);
     },
     {Is(Verdict::kUnknown), Says(HasSubstr("random walk")),
      NotNamed({"drift", "scale", "clock_rate", "slip"}, 0.5)},
     {7, 8, 9, 10}},
    // In one pass of one turn every low order, a drift and a scale are pieces of it; it is seen before any of them
    // is sought.
    {"AWalkWithinOneTurnIsNoOrder",
     [](unsigned seed) {
       return Walked({0.0, 0.018, 20000, 1, 0.01, "sweep"}, 0.002, 0.002, seed);
     },
     {Says(StartsWith("random walk")), HasCauses(0)},
     {3}}};  // one that does not come back to where it was by chance
INSTANTIATE_TEST_SUITE_P(Memory, EncoderAnswer, testing::ValuesIn(kMemory), NameOfRow);

/// Forward and back once; the noise has a deviation of 0.02 deg and remembers this much of what it was a reading
/// ago.
Record Remembering(int readings, double correlation, std::uint64_t seed) {
  Noise unit(1.0, seed);
  Record record;
  double x = unit();
  for (int k = 0; k < readings; ++k) {
    const bool is_back = 2 * k >= readings;
    const double angle_deg = 720.0 * (is_back ? readings - 1 - k : k) / readings;
    record.Add(0.1 * k, angle_deg, angle_deg + 0.02 * x, is_back ? -1 : 1, 0);
    x = correlation * x + std::sqrt(1.0 - correlation * correlation) * unit();
  }
  return record;
}

TEST(EncoderMemory, NoiseThatRemembersAFewReadingsIsNoWalk) {
  const int alarms = twinbench::test::CountOverSeeds(12, [](std::uint64_t seed) {
    return Ask(Remembering(240, 0.85, seed)).run.diagnosis.verdict != Verdict::kNone;
  });
  EXPECT_LE(alarms, 1);
}

/// What many columns have as coefficients exceeds what they sum up to tenfold.
TEST(EncoderMemory, AWalkIsToldAsLargeAsItShows) {
  const int told = twinbench::test::CountOverSeeds(6, [](std::uint64_t seed) {
    const std::string words = Ask(Remembering(190, 0.97, seed)).run.diagnosis.unknown.signature;
    const std::size_t at = words.find("random walk");
    if (at == std::string::npos) return false;
    EXPECT_LT(std::stod(words.substr(words.find("amplitude ", at) + 10)), 2.0 * std::sqrt(2.0) * 0.02) << words;
    return true;
  });
  EXPECT_GE(told, 2);
}

// What laboratories record most: positioning tests, rooms that warm up, zeros that walk. By closed forms.

const std::array kCurve_deg = {0.031, -0.012, 0.044, 0.006, -0.038, 0.021, -0.027, 0.013, -0.009};
const std::array kReversalAt_deg = {0.0030, -0.0021, 0.0012, -0.0034, 0.0018, 0.0007, -0.0026, 0.0031, -0.0017};

/// Five times to every target from either side, without a clock: a curve, a reversal that differs from target to
/// target, and a creep from cycle to cycle.
Record PositioningTest(double noise_deg, unsigned seed) {
  return Listed({-20.0, 5.0, 9, 10}, noise_deg, seed, [](const Place& at) {
    const auto k = static_cast<std::size_t>(at.stop);
    return kCurve_deg[k] - 0.5 * at.direction * (0.021 + kReversalAt_deg[k]) - 0.0015 * (at.pass / 2);
  });
}

/// What lags behind the temperature of the room by a first order, exact for one that goes straight from reading to
/// reading.
/// @param growth_K  Of the scale; 0: it is the zero that follows.
Record FollowsTheRoom(double lag_s, double growth_K, unsigned seed) {
  double follower_K = 0.0, last_K = 0.0;
  const auto room_K = [](double t_s) { return 1.5 * std::sin(2.0 * units::kPi * t_s / 3600.0) + 1e-4 * t_s; };
  Record record = Listed({0.0, 0.9, 400, 1, 20.0, "sweep"}, 0.001, seed, [&](const Place& at) {
    if (at.stop > 0) {
      const double behind_K = (room_K(at.t_s) - last_K) / 20.0 * lag_s;
      follower_K = room_K(at.t_s) - behind_K + (follower_K - last_K + behind_K) * std::exp(-20.0 / lag_s);
    }
    last_K = room_K(at.t_s);
    return (growth_K != 0.0 ? growth_K * at.deg : 0.01) * follower_K + Sum({{1, 0.02, 0.0}}, at.deg);
  });
  for (Reading& r : record.readings) r.temperature_degC = 20.0 + room_K(20.0 * r.reading);
  return record;
}

/// Neighbours in time are far apart on the axis, whose scale is then no noise.
Record InAnyOrder(double ratio, unsigned seed) {
  Noise noise_deg(0.02, seed);
  Record record{"stops"};
  double before_deg = 0.0;
  for (const double at_deg :
       {-30.0, 60.0, 0.0, -90.0, 45.0, 30.0, -60.0, 90.0, -45.0, 60.0, -90.0, 0.0, 90.0, -30.0}) {
    const auto n = static_cast<int>(std::ssize(record.readings));
    record.Add(4.0 * n, at_deg, (1.0 + ratio) * at_deg + noise_deg(), at_deg > before_deg ? 1 : -1, n);
    before_deg = at_deg;
  }
  return record;
}

const Row kPositioning[] = {
    {"TheReversalIsTheMeanOverAllTargetsBesideTheirErrors",
     [](unsigned seed) { return PositioningTest(0.0008, seed); },
     {Named("backlash", 0.75), Size("backlash", "width", 0.021, 0.0008),  // theirs have a mean of 0
      Says(Not(HasSubstr("lost counts"))), Says(HasSubstr("error of its own at each of 9 targets")), kSilentAgain},
     {1, 2, 3}},
    {"AZeroThatFollowsTheTemperatureIsNoFunctionOfTime",
     [](unsigned seed) { return FollowsTheRoom(900.0, 0.0, seed); },
     {Found("zero_temperature", "coefficient", 0.01), Found("zero_temperature", "lag", 900.0),
      NotNamed({"drift"}, 0.0), kSilentAgain},
     {6}},
    {"AScaleThatGrowsWithTheTemperatureIsNeitherAZeroNorADrift",
     [](unsigned seed) { return FollowsTheRoom(300.0, 80e-6, seed); },
     {Found("scale_temperature", "growth", 80.0), Found("scale_temperature", "lag", 300.0),
      NotNamed({"drift", "zero_temperature", "scale"}, 0.0), kSilentAgain},
     {6, 7}},
    OfCourse("ASlipIsOneWhereItIsSuddenAndSmall", {0.0, 2.0, 600, 1, 0.5, "sweep"}, 0.004,
             [](const Place& at) { return at.stop < 350 ? 0.0 : 0.006; },
             {Named("slip", 0.5), Size("slip", "step", 0.006, 0.0015)}, {10, 11, 12}),
    OfCourse("ABumpIsNoTwoSlips", {0.0, 2.4, 124, 1, 0.5, "stops"}, 0.15,
             [](const Place& at) { return 1e-4 * at.deg * (300.0 - at.deg) + 0.9 * std::exp(-std::pow((at.deg - 140.0) / 8.0, 2)); },
             {Named("scale"), NotNamed({"slip"}, 0.0), Says(HasSubstr("bump from reading 5"))}, {13, 14}),
    // Behind a reversal a loop that takes half of the axis is like a line and a step of the direction.
    OfCourse("PlayBesideAScaleThatBendsIsNoLoopOverHalfTheAxis", {0.0, 55.5, 10, 10, 0.5, "stops"}, 0.0005,
             [](const Place& at) { return -0.0038 * at.direction - 4.42e-5 * at.deg + 5.56e-8 * at.deg * at.deg; },
             {Named("scale"), Size("backlash", "width", 0.0076, 0.0003), NotNamed({"hysteresis"}, 0.0)}, {1, 2, 3, 4, 5, 6, 7, 8}),
    {"TargetsInAnyOrderShowAScale",
     [](unsigned seed) { return InAnyOrder(0.012, seed); },
     {Found("scale", "ratio", 0.012, 1e-3), kSilentAgain},
     {140}}};
INSTANTIATE_TEST_SUITE_P(Positioning, EncoderAnswer, testing::ValuesIn(kPositioning), NameOfRow);

TEST(EncoderPositioning, TheFileOfOneTestPredictsTheCurveOfTheNext) {
  const Record first = PositioningTest(0.0005, 4), next = PositioningTest(0.0005, 5);
  const Scenario extended = Extend(first.Believed(), Diagnosed(first, first.Believed()), "test");
  const Diagnosis again = Diagnosed(next, extended).diagnosis;
  // Ten readings behind each number of the curve.
  EXPECT_EQ(again.unknown.signature.find("error of its own"), std::string::npos) << again.unknown.signature;
}

TEST(Memory, OfWhiteNoiseIsOneAndOfAWalkIsLongAlongWhatIsSlow) {
  constexpr int kReadings = 1200;
  const Eigen::VectorXd slow = Eigen::VectorXd::LinSpaced(kReadings, -1.0, 1.0);
  const Eigen::Array2d of_white_and_walk = twinbench::test::MeanOverSeeds(200, [&](std::uint64_t seed) {
    Noise normal(1.0, seed);
    const Eigen::VectorXd white = Eigen::VectorXd::NullaryExpr(kReadings, [&] { return normal(); });
    Eigen::VectorXd walk(kReadings);
    std::partial_sum(white.begin(), white.end(), walk.begin());
    return Eigen::Array2d(MemoryAlong(slow, white), MemoryAlong(slow, walk.array() - walk.mean()));
  });
  EXPECT_NEAR(of_white_and_walk[0], 1.0, 0.15);  // twelve stretches of unlike weight scatter by some 0.6 a run
  EXPECT_GT(of_white_and_walk[1], 50.0);         // a stretch of 100 readings that hardly changes counts for one
}

}  // namespace
}  // namespace twinbench::diagnose::encoder
