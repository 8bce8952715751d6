#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "tests/diagnose/encoder_record.h"

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
  for (const unsigned seed : {1u, 2u, 3u}) {
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
  std::mt19937_64 random(seed);
  std::normal_distribution<double> unit;
  Record record;
  double x = unit(random);
  for (int k = 0; k < readings; ++k) {
    const bool is_back = 2 * k >= readings;
    const double angle_deg = 720.0 * (is_back ? readings - 1 - k : k) / readings;
    record.Add(0.1 * k, angle_deg, angle_deg + 0.02 * x, is_back ? -1 : 1, 0);
    x = correlation * x + std::sqrt(1.0 - correlation * correlation) * unit(random);
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
  for (const unsigned seed : {7u, 8u, 9u, 10u}) {
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

}  // namespace
}  // namespace twinbench::diagnose::encoder
