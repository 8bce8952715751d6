#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/diagnose/encoder_record.h"

// Devices that come to rest after their reference, in time, beside what goes by the way.
namespace twinbench::diagnose::encoder {
namespace {

using namespace lab;

struct Rests {
  double left_deg, over_s;  // of a move when it has ended, and the time in which 63 % of it are gone
  double warm_up_deg;       // drift that settles in 300 s
};

/// 36 stops there and back twice, each read six times while it comes to rest.
Record ComesToRest(const Rests& rests, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0.0, 0.0015);
  Record record;
  record.kind = "stops";
  double t_s = 0.0;
  for (int pass = 0; pass < 4; ++pass) {
    const int sense = pass % 2 == 0 ? 1 : -1;
    for (int k = 0; k < 36; ++k) {
      const double at_deg = 0.7 + 10.0 * (sense > 0 ? k : 35 - k);
      t_s += 3.0;
      for (int again = 0; again < 6; ++again) {
        const double now_s = t_s + 0.8 * again;
        const double error_deg = -sense * rests.left_deg * std::exp(-0.8 * again / rests.over_s) +
                                 rests.warm_up_deg * (1.0 - std::exp(-now_s / 300.0));
        record.Add(now_s, at_deg, at_deg + error_deg + noise(random), sense, pass);
      }
      t_s += 4.0;
    }
  }
  return record;
}

TEST(EncoderSettling, IsNoHysteresis) {
  for (const double over_s : {0.6, 1.7}) {
    const Answer answer = Ask(ComesToRest({0.03, over_s, 0.0}, 120));
    EXPECT_TRUE(answer.Names("settling")) << over_s << ": " << answer.Words();
    EXPECT_NEAR(answer.Value("settling", "amplitude"), 0.03, 4.0 * answer.Uncertainty("settling", "amplitude"));
    EXPECT_NEAR(answer.Value("settling", "time_constant"), over_s,
                4.0 * answer.Uncertainty("settling", "time_constant"));
    EXPECT_EQ(answer.run.diagnosis.causes.size(), 1U) << over_s << ": " << answer.Words();
    EXPECT_EQ(answer.again.verdict, Verdict::kNone) << over_s << ": " << answer.Words();
  }
}

TEST(EncoderSettling, IsFoundBesideAWarmUp) {
  const Answer answer = Ask(ComesToRest({0.02, 1.2, 0.025}, 121));
  EXPECT_TRUE(answer.Names("settling") && answer.Names("drift")) << answer.Words();
  EXPECT_NEAR(answer.Value("settling", "amplitude"), 0.02, 4.0 * answer.Uncertainty("settling", "amplitude"));
  EXPECT_NEAR(answer.Value("drift", "warm_up"), 300.0, 4.0 * answer.Uncertainty("drift", "warm_up"));
  EXPECT_FALSE(answer.Names("hysteresis", 0.1)) << answer.Words();
  EXPECT_EQ(answer.again.verdict, Verdict::kNone) << answer.Words();
}

}  // namespace
}  // namespace twinbench::diagnose::encoder
