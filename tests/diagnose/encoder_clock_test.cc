#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/diagnose/encoder_record.h"

// Two series with a clock each, of which one runs fast: the shaft is where it was at another time.
namespace twinbench::diagnose::encoder {
namespace {

using namespace lab;

/// What the device shows when the reference's clock says t.
template <class Shows>
Record ReadBy(unsigned seed, Shows shows_deg) {
  const Swing swing{500.0, 37.0};
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0.0, 0.004);
  Record record;
  for (double t_s = 0.03; t_s < 130.0; t_s += 0.13)
    record.Add(t_s, swing.At(t_s), shows_deg(swing, t_s) + noise(random), swing.Direction(t_s), swing.Pass(t_s));
  return record;
}

TEST(EncoderClock, ThatRunsFastIsFoundWithItsRate) {
  for (const double ratio : {2e-5, -3e-4, 2e-3}) {
    const Answer answer =
        Ask(ReadBy(70, [ratio](const Swing& swing, double t_s) { return swing.At(t_s / (1.0 + ratio)); }));
    EXPECT_TRUE(answer.Names("clock_rate")) << ratio << ": " << answer.Words();
    // A clock that shows t when t / (1 + ratio) has passed is late by ratio t to first order.
    EXPECT_NEAR(answer.Value("clock_rate", "ratio"), ratio,
                4.0 * answer.Uncertainty("clock_rate", "ratio") + ratio * ratio);
    EXPECT_EQ(answer.run.diagnosis.causes.size(), 1U) << ratio << ": " << answer.Words();
    EXPECT_EQ(answer.again.verdict, Verdict::kNone) << ratio << ": " << answer.Words();
  }
}

TEST(EncoderClock, ThatRunsFastAndAReadingThatIsLateAreBoth) {
  const Answer answer =
      Ask(ReadBy(71, [](const Swing& swing, double t_s) { return swing.At(t_s * (1.0 - 4e-4) - 0.012); }));
  EXPECT_TRUE(answer.Names("clock_rate") && answer.Names("latency")) << answer.Words();
  EXPECT_NEAR(answer.Value("clock_rate", "ratio"), 4e-4, 4.0 * answer.Uncertainty("clock_rate", "ratio"));
  EXPECT_NEAR(answer.Value("latency", "delay"), 0.012, 4.0 * answer.Uncertainty("latency", "delay"));
  EXPECT_EQ(answer.again.verdict, Verdict::kNone) << answer.Words();
}

TEST(EncoderClock, IsNotToBlameForAScaleOrForWhatTheSpeedDoes) {
  const Swing same{500.0, 37.0};
  const auto speed_deg_s = [&](double t_s) { return (same.At(t_s + 1e-3) - same.At(t_s - 1e-3)) / 2e-3; };
  const Answer scale = Ask(ReadBy(72, [](const Swing& swing, double t_s) { return 1.0002 * swing.At(t_s); }));
  EXPECT_TRUE(scale.Names("scale")) << scale.Words();
  EXPECT_FALSE(scale.Names("clock_rate", 0.1)) << scale.Words();
  const Answer resonance = Ask(ReadBy(73, [&](const Swing& swing, double t_s) {
    const double v = speed_deg_s(t_s), x = (std::abs(v) - 22.0) / 4.0;
    return swing.At(t_s) + std::copysign(0.05, v) / (1.0 + x * x);
  }));
  EXPECT_FALSE(resonance.Names("clock_rate", 0.5)) << resonance.Words();
  const Answer growing = Ask(ReadBy(74, [&](const Swing& swing, double t_s) {
    const double v = speed_deg_s(t_s);
    return swing.At(t_s) + 3e-5 * v * std::abs(v) * t_s / 130.0;
  }));
  EXPECT_FALSE(growing.Names("clock_rate", 0.5)) << growing.Words();
}

}  // namespace
}  // namespace twinbench::diagnose::encoder
