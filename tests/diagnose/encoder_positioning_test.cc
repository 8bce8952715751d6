#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/diagnose/encoder_record.h"
#include "twin/benches/encoder_comparison/diagnosis/memory.h"
#include "twin/core/reading_clock.h"

namespace twinbench::diagnose::encoder {
namespace {

using namespace lab;

// What laboratories record most: positioning tests, rooms that warm up, zeros that walk. By closed forms.

constexpr int kTargets = 9, kCycles = 5;
const double kCurve_deg[kTargets] = {0.031, -0.012, 0.044, 0.006, -0.038, 0.021, -0.027, 0.013, -0.009};
const double kReversalAt_deg[kTargets] = {0.0030, -0.0021, 0.0012, -0.0034, 0.0018, 0.0007, -0.0026, 0.0031, -0.0017};

/// Five times to every target from either side, without a clock: a curve, a reversal that differs from target to
/// target, and a creep from cycle to cycle.
Record PositioningTest(double reversal_deg, double noise_deg, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0.0, noise_deg);
  Record record;
  record.kind = "stops";
  for (int cycle = 0; cycle < kCycles; ++cycle) {
    for (int k = 0; k < 2 * kTargets; ++k) {
      const int target = k < kTargets ? k : 2 * kTargets - 1 - k, sense = k < kTargets ? 1 : -1;
      const double at_deg = 5.0 * target - 20.0;
      const double error_deg = kCurve_deg[target] - 0.5 * sense * (reversal_deg + kReversalAt_deg[target]) - 0.0015 * cycle;
      record.Add(cycle * 2 * kTargets + k, at_deg, at_deg + error_deg + noise(random), sense, 2 * cycle + (sense < 0));
      record.readings.back().extra[kClockColumn] = kNoClock;
    }
  }
  return record;
}

TEST(EncoderPositioning, TheReversalIsTheMeanOverAllTargetsBesideTheirErrors) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    const Answer answer = Ask(PositioningTest(0.021, 0.0008, seed));
    SCOPED_TRACE(answer.Words());
    EXPECT_TRUE(answer.Names("backlash", 0.75));
    EXPECT_NEAR(answer.Value("backlash", "width"), 0.021, 0.0008);  // theirs have a mean of 0
    EXPECT_EQ(answer.run.diagnosis.unknown.signature.find("lost counts"), std::string::npos);
    EXPECT_NE(answer.run.diagnosis.unknown.signature.find("error of its own at each of 9 targets"), std::string::npos);
    EXPECT_EQ(answer.again.verdict, Verdict::kNone) << "the file holds the curve, too";
  }
}

TEST(EncoderPositioning, TheFileOfOneTestPredictsTheCurveOfTheNext) {
  const Record first = PositioningTest(0.021, 0.0005, 4), next = PositioningTest(0.021, 0.0005, 5);
  const Scenario extended = Extend(first.Believed(), Diagnosed(first, first.Believed()), "test");
  const Diagnosis again = Diagnosed(next, extended).diagnosis;
  // Ten readings behind each number of the curve.
  EXPECT_EQ(again.unknown.signature.find("error of its own"), std::string::npos) << again.unknown.signature;
}

TEST(EncoderPositioning, AZeroThatFollowsTheTemperatureIsNoFunctionOfTime) {
  std::mt19937_64 random(6);
  std::normal_distribution<double> noise_deg(0.0, 0.001);
  Record record;
  constexpr double kLag_s = 900.0;
  double follower_K = 0.0, last_K = 0.0;
  for (int k = 0; k < 400; ++k) {
    const double t_s = 20.0 * k, room_K = 1.5 * std::sin(2.0 * units::kPi * t_s / 3600.0) + 1e-4 * t_s;
    // Exact for a room that goes straight from reading to reading.
    if (k > 0) {
      const double slope = (room_K - last_K) / 20.0, behind = slope * kLag_s;
      follower_K = room_K - behind + (follower_K - last_K + behind) * std::exp(-20.0 / kLag_s);
    }
    last_K = room_K;
    const double at_deg = 0.9 * k;
    record.Add(t_s, at_deg, at_deg + 0.01 * follower_K + 0.02 * std::cos(at_deg * units::deg) + noise_deg(random), 1, 0);
    record.readings.back().temperature_degC = 20.0 + room_K;
  }
  const Answer answer = Ask(record);
  SCOPED_TRACE(answer.Words());
  EXPECT_TRUE(answer.Names("zero_temperature"));
  EXPECT_NEAR(answer.Value("zero_temperature", "coefficient"), 0.01, 4.0 * answer.Uncertainty("zero_temperature", "coefficient"));
  EXPECT_NEAR(answer.Value("zero_temperature", "lag"), kLag_s, 4.0 * answer.Uncertainty("zero_temperature", "lag"));
  EXPECT_EQ(answer.Find("drift"), nullptr);
  EXPECT_EQ(answer.again.verdict, Verdict::kNone);
}

TEST(EncoderPositioning, ASlipIsOneWhereItIsSuddenAndSmall) {
  for (const unsigned seed : {10u, 11u, 12u}) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> noise_deg(0.0, 0.004);
    Record record;
    for (int k = 0; k < 600; ++k) record.Add(0.5 * k, 2.0 * k, 2.0 * k + (k < 350 ? 0.0 : 0.006) + noise_deg(random), 1, 0);
    const Answer answer = Ask(record);
    EXPECT_TRUE(answer.Names("slip", 0.5)) << answer.Words();
    EXPECT_NEAR(answer.Value("slip", "step"), 0.006, 0.0015) << answer.Words();
  }
}

TEST(Memory, OfWhiteNoiseIsOneAndOfAWalkIsLongAlongWhatIsSlow) {
  std::mt19937_64 random(13);
  std::normal_distribution<double> normal(0.0, 1.0);
  constexpr int kReadings = 1200, kRuns = 200;
  double of_white = 0.0, of_walk = 0.0;
  const Eigen::VectorXd slow = Eigen::VectorXd::LinSpaced(kReadings, -1.0, 1.0);
  for (int run = 0; run < kRuns; ++run) {
    Eigen::VectorXd white(kReadings), walk(kReadings);
    double sum = 0.0;
    for (int k = 0; k < kReadings; ++k) {
      white[k] = normal(random);
      walk[k] = sum += normal(random);
    }
    of_white += MemoryAlong(slow, white) / kRuns;
    of_walk += MemoryAlong(slow, walk.array() - walk.mean()) / kRuns;
  }
  EXPECT_NEAR(of_white, 1.0, 0.15);  // twelve stretches of unlike weight scatter by some 0.6 a run
  EXPECT_GT(of_walk, 50.0);          // a stretch of 100 readings that hardly changes counts for one
}

/// Neighbours in time are far apart on the axis, whose scale is then no noise.
TEST(EncoderPositioning, TargetsInAnyOrderShowAScale) {
  constexpr double kRatio = 0.012;
  std::mt19937 random(140);
  std::normal_distribution<double> noise(0.0, 0.02);
  Record record;
  record.kind = "stops";
  double before_deg = 0.0;
  for (const double at_deg : {-30.0, 60.0, 0.0, -90.0, 45.0, 30.0, -60.0, 90.0, -45.0, 60.0, -90.0, 0.0, 90.0, -30.0}) {
    const auto n = static_cast<int>(std::ssize(record.readings));
    record.Add(4.0 * n, at_deg, (1.0 + kRatio) * at_deg + noise(random), at_deg > before_deg ? 1 : -1, n);
    before_deg = at_deg;
  }
  ExpectFound(Ask(record), {{"scale", "ratio", kRatio, 1e-3}});
}

}  // namespace
}  // namespace twinbench::diagnose::encoder
