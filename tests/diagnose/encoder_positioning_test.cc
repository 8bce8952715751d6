#include <gtest/gtest.h>

#include <random>

#include "tests/diagnose/encoder_record.h"
#include "twin/benches/encoder_comparison/diagnosis/memory.h"
#include "twin/core/reading_clock.h"

namespace twinbench::diagnose::encoder {
namespace {

using namespace lab;

// Recordings whose noise remembers what it was.

/// x_k = 1.2 x_(k-1) - 0.6 x_(k-2) + e_k: the noise of a sensor that rings, of this deviation.
class RingingNoise {
 public:
  RingingNoise(double deviation, unsigned seed) : random_(seed), step_(0.0, deviation * std::sqrt(0.28)) {}

  double Next() {
    const double x = 1.2 * last_ - 0.6 * before_ + step_(random_);
    before_ = last_;
    return last_ = x;
  }

 private:
  std::mt19937_64 random_;
  std::normal_distribution<double> step_;
  double last_ = 0.0, before_ = 0.0;
};

/// Six seconds of a motor that swings once a second, and a tilt sensor that is late and shows too little.
Record LateAndShort(double late_s, double scale, double noise_deg, unsigned seed) {
  const Swing swing{36.0, 1.0, -18.0};
  RingingNoise noise(noise_deg, seed);
  return Swung(swing, 0.0, 6.0, 0.002, 1e-6, seed,
               [&](double t_s) { return (1.0 + scale) * swing.At(t_s - late_s) + noise.Next(); });
}

TEST(EncoderMemory, ALagAndAScaleAreNoLoopThatFollowsBoth) {
  for (const unsigned seed : Seeds({1u, 2u, 3u})) {
    const Answer answer = Ask(LateAndShort(0.0114, -0.05, 0.1, seed));
    SCOPED_TRACE(answer.Words());
    EXPECT_TRUE(answer.Names("latency"));
    EXPECT_TRUE(answer.Names("scale"));
    EXPECT_FALSE(answer.Names("hysteresis", 0.5) || answer.Names("backlash", 0.5));
    // Its velocity is that of what it shows: a twentieth less.
    EXPECT_NEAR(answer.Value("latency", "delay"), 0.95 * 0.0114, 0.02 * 0.0114);
    EXPECT_NEAR(answer.Value("scale", "ratio"), -0.05, 0.02 * 0.05);
  }
}

/// Forward and back once; the noise has a deviation of 0.02 deg and remembers this much of what it was a reading ago.
Record Remembering(int readings, double correlation, unsigned seed) {
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
  int alarms = 0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    const Answer answer = Ask(Remembering(240, 0.85, seed));
    if (answer.run.diagnosis.verdict != Verdict::kNone) ++alarms;
  }
  EXPECT_LE(alarms, 1);
}

/// What many columns have as coefficients exceeds what they sum up to tenfold.
TEST(EncoderMemory, AWalkIsToldAsLargeAsItShows) {
  int told = 0;
  for (unsigned seed = 1; seed <= 6; ++seed) {
    const Answer answer = Ask(Remembering(190, 0.97, seed));
    const std::string& words = answer.run.diagnosis.unknown.signature;
    const std::size_t at = words.find("random walk"), amplitude = words.find("amplitude ", at);
    if (at == std::string::npos) continue;
    ++told;
    EXPECT_LT(std::stod(words.substr(amplitude + 10)), 2.0 * std::sqrt(2.0) * 0.02) << words;
  }
  EXPECT_GE(told, 2);
}

TEST(EncoderMemory, ARandomWalkIsNoDriftAndNoScale) {
  for (const unsigned seed : Seeds({7u, 8u, 9u, 10u})) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> step_deg(0.0, 0.001), noise_deg(0.0, 0.0015);
    Record record;
    double walk_deg = 0.0;
    for (int k = 0; k < 900; ++k) {
      walk_deg += step_deg(random);
      record.Add(0.5 * k, 2.0 * k, 2.0 * k + walk_deg + noise_deg(random), 1, k / 180);
    }
    const Answer answer = Ask(record);
    SCOPED_TRACE(answer.Words());
    EXPECT_EQ(answer.run.diagnosis.verdict, Verdict::kUnknown);
    EXPECT_NE(answer.run.diagnosis.unknown.signature.find("random walk"), std::string::npos);
    for (const char* slow : {"drift", "scale", "clock_rate", "slip"}) EXPECT_FALSE(answer.Names(slow, 0.5)) << slow;
  }
}

/// In one pass of one turn every low order, a drift and a scale are pieces of it; it is seen before any of them is sought.
TEST(EncoderMemory, AWalkWithinOneTurnIsNoOrder) {
  std::mt19937_64 random(3);  // one that does not come back to where it was by chance
  std::normal_distribution<double> step_deg(0.0, 0.002);
  Record record;
  double walk_deg = 0.0;
  for (int k = 0; k < 20000; ++k) {
    walk_deg += step_deg(random);
    record.Add(0.01 * k, 0.018 * k, 0.018 * k + walk_deg + step_deg(random), 1, 0);
  }
  const Diagnosis found = Ask(record).run.diagnosis;
  EXPECT_TRUE(found.unknown.signature.starts_with("random walk")) << found.unknown.signature;
  EXPECT_TRUE(found.causes.empty());
}

// What laboratories record most: positioning tests, rooms that warm up, zeros that walk. By closed forms.

constexpr int kTargets = 9, kCycles = 5;
const double kCurve_deg[kTargets] = {0.031, -0.012, 0.044, 0.006, -0.038, 0.021, -0.027, 0.013, -0.009};
const double kReversalAt_deg[kTargets] = {0.0030, -0.0021, 0.0012, -0.0034, 0.0018, 0.0007, -0.0026, 0.0031, -0.0017};

/// Five times to every target from either side, without a clock: a curve, a reversal that differs from target to
/// target, and a creep from cycle to cycle.
Record PositioningTest(double reversal_deg, double noise_deg, unsigned seed) {
  Noise noise(noise_deg, seed);
  Record record{"stops"};
  for (int cycle = 0; cycle < kCycles; ++cycle) {
    for (int k = 0; k < 2 * kTargets; ++k) {
      const int target = k < kTargets ? k : 2 * kTargets - 1 - k, sense = k < kTargets ? 1 : -1;
      const double at_deg = 5.0 * target - 20.0;
      const double error_deg = kCurve_deg[target] - 0.5 * sense * (reversal_deg + kReversalAt_deg[target]) - 0.0015 * cycle;
      record.Add(cycle * 2 * kTargets + k, at_deg, at_deg + error_deg + noise(), sense, 2 * cycle + (sense < 0));
      record.readings.back().extra[kClockColumn] = kNoClock;
    }
  }
  return record;
}

TEST(EncoderPositioning, TheReversalIsTheMeanOverAllTargetsBesideTheirErrors) {
  for (const unsigned seed : Seeds({1u, 2u, 3u})) {
    const Answer answer = Ask(PositioningTest(0.021, 0.0008, seed));
    SCOPED_TRACE(answer.Words());
    EXPECT_TRUE(answer.Names("backlash", 0.75));
    EXPECT_NEAR(answer.Value("backlash", "width"), 0.021, 0.0008);  // theirs have a mean of 0
    EXPECT_EQ(answer.run.diagnosis.unknown.signature.find("lost counts"), std::string::npos);
    EXPECT_NE(answer.run.diagnosis.unknown.signature.find("error of its own at each of 9 targets"), std::string::npos);
    EXPECT_EQ(answer.Again().verdict, Verdict::kNone) << "the file holds the curve, too";
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
  Noise noise_deg(0.001, 6);
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
    record.Add(t_s, at_deg, at_deg + 0.01 * follower_K + 0.02 * std::cos(at_deg * units::deg) + noise_deg(), 1, 0);
    record.readings.back().temperature_degC = 20.0 + room_K;
  }
  const Answer answer = Ask(record);
  SCOPED_TRACE(answer.Words());
  EXPECT_TRUE(answer.Names("zero_temperature"));
  EXPECT_NEAR(answer.Value("zero_temperature", "coefficient"), 0.01, 4.0 * answer.Uncertainty("zero_temperature", "coefficient"));
  EXPECT_NEAR(answer.Value("zero_temperature", "lag"), kLag_s, 4.0 * answer.Uncertainty("zero_temperature", "lag"));
  EXPECT_EQ(answer.Find("drift"), nullptr);
  EXPECT_EQ(answer.Again().verdict, Verdict::kNone);
}

TEST(EncoderPositioning, ASlipIsOneWhereItIsSuddenAndSmall) {
  for (const unsigned seed : Seeds({10u, 11u, 12u})) {
    Noise noise_deg(0.004, seed);
    Record record;
    for (int k = 0; k < 600; ++k) record.Add(0.5 * k, 2.0 * k, 2.0 * k + (k < 350 ? 0.0 : 0.006) + noise_deg(), 1, 0);
    const Answer answer = Ask(record);
    EXPECT_TRUE(answer.Names("slip", 0.5)) << answer.Words();
    EXPECT_NEAR(answer.Value("slip", "step"), 0.006, 0.0015) << answer.Words();
  }
}

TEST(Memory, OfWhiteNoiseIsOneAndOfAWalkIsLongAlongWhatIsSlow) {
  Noise normal(1.0, 13);
  constexpr int kReadings = 1200, kRuns = 200;
  double of_white = 0.0, of_walk = 0.0;
  const Eigen::VectorXd slow = Eigen::VectorXd::LinSpaced(kReadings, -1.0, 1.0);
  for (int run = 0; run < kRuns; ++run) {
    Eigen::VectorXd white(kReadings), walk(kReadings);
    double sum = 0.0;
    for (int k = 0; k < kReadings; ++k) {
      white[k] = normal();
      walk[k] = sum += normal();
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
  Record record{"stops"};
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
