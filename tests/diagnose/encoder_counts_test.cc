#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/diagnose/encoder_record.h"

// Counters that lose counts, written down as they count.
namespace twinbench::diagnose::encoder {
namespace {

using namespace lab;

bool Has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// There and back in motion, two turns and a bit, twice; `lost_deg` of the readings from `number` on, by time.
template <class Lost>
Record Counted(double noise_deg, unsigned seed, Lost lost_deg) {
  const Swing swing{790.0, 80.0};
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0.0, noise_deg);
  Record record;
  double last_deg = 0.0, lost = 0.0;
  for (double t_s = 0.05; t_s < 160.0; t_s += 0.11) {
    const double at_deg = 11.0 + swing.At(t_s);
    if (!record.readings.empty()) lost += lost_deg(t_s, last_deg, at_deg);
    last_deg = at_deg;
    record.Add(t_s, at_deg, at_deg + lost + noise(random), swing.Direction(t_s), swing.Pass(t_s));
  }
  return record;
}

void ExpectOneUnknown(const Answer& answer, const std::string& words) {
  EXPECT_EQ(answer.run.diagnosis.verdict, Verdict::kUnknown) << answer.Words();
  EXPECT_TRUE(Has(answer.run.diagnosis.unknown.signature, words)) << answer.Words();
  EXPECT_FALSE(answer.Names("slip", 0.01) || answer.Names("scale", 0.5)) << answer.Words();
  EXPECT_EQ(answer.again.verdict, Verdict::kNone) << answer.Words();
}

double Whole(double angle_deg, double spot_deg) {
  return std::floor((angle_deg - spot_deg) / 360.0);
}

TEST(EncoderCounts, LostAtOneSpotInOneSenseAreOneUnknown) {
  const Answer answer = Ask(Counted(0.003, 60, [](double, double from_deg, double to_deg) {
    return -0.02 * std::max(0.0, Whole(to_deg, 137.0) - Whole(from_deg, 137.0));
  }));
  ExpectOneUnknown(answer, "lost counts, the same each time that 13");
}

TEST(EncoderCounts, ThatComeBackOnTheWayBackAreOneUnknown) {
  const Answer answer = Ask(Counted(0.003, 61, [](double, double from_deg, double to_deg) {
    return -0.0125 * (Whole(to_deg, 0.0) - Whole(from_deg, 0.0));
  }));
  ExpectOneUnknown(answer, "which come back");
}

TEST(EncoderCounts, OfATurnThatIsNotWholeAreNoScale) {
  const Answer answer = Ask(Counted(0.003, 62, [](double, double from_deg, double to_deg) {
    return 0.03 * ((to_deg - from_deg) / 360.0 - (Whole(to_deg, 77.0) - Whole(from_deg, 77.0)));
  }));
  ExpectOneUnknown(answer, "put right at 7");
}

TEST(EncoderCounts, EqualStepsAreOneUnknownWithSeveralEvents) {
  const auto at = [](double event_s, double t_s) { return t_s >= event_s && t_s < event_s + 0.11 - 1e-9; };
  const Answer answer = Ask(Counted(0.003, 63, [&](double t_s, double, double) {
    return at(31.0, t_s) || at(58.0, t_s) ? -0.022 : at(117.0, t_s) ? 0.022 : at(140.0, t_s) ? -0.044 : 0.0;
  }));
  ExpectOneUnknown(answer, "4 steps of one size");
}

TEST(EncoderCounts, TwoStepsThatAreNotAlikeAreTwoSlips) {
  const auto at = [](double event_s, double t_s) { return t_s >= event_s && t_s < event_s + 0.11 - 1e-9; };
  const Answer answer = Ask(Counted(0.003, 64, [&](double t_s, double, double) {
    return at(31.0, t_s) ? -0.05 : at(117.0, t_s) ? 0.033 : 0.0;
  }));
  const auto& causes = answer.run.diagnosis.causes;
  EXPECT_EQ(std::ranges::count(causes, "slip", &Cause::effect), 2) << answer.Words();
  EXPECT_EQ(answer.again.verdict, Verdict::kNone) << answer.Words();
}

}  // namespace
}  // namespace twinbench::diagnose::encoder
