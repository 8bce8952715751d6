#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/diagnose/encoder_record.h"

// Tests of positioning as ISO 230-2 has them: targets that are no even way apart, approached from both sides again
// and again, an axis with a curve of its own and a reversal. A mm is written as a degree.
namespace twinbench::diagnose::encoder {
namespace {

using namespace lab;

struct Axis {
  double length_mm, targets, curve_um, reversal_um, noise_um, warm_up_um;

  double Curve_um(double x_mm) const {
    const double u = x_mm / length_mm;
    return curve_um * (4.0 * u * (1.0 - 0.8 * u) + 0.13 * std::sin(10.7 * u + 1.0) + 0.07 * std::cos(27.0 * u));
  }
};

Record Positioned(const Axis& axis, int passes, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise_um(0.0, axis.noise_um);
  std::uniform_real_distribution<double> uneven(-0.15, 0.15);
  std::vector<double> targets_mm;
  for (int k = 0; k < axis.targets; ++k) targets_mm.push_back(axis.length_mm / axis.targets * (k + uneven(random)));
  Record record;
  record.kind = "stops";
  for (int pass = 0; pass < passes; ++pass) {
    const int sense = pass % 2 == 0 ? 1 : -1;
    for (std::size_t k = 0; k < targets_mm.size(); ++k) {
      const double x_mm = targets_mm[sense > 0 ? k : targets_mm.size() - 1 - k];
      const double t_s = 7.0 * static_cast<double>(record.readings.size());
      const double error_um = axis.Curve_um(x_mm) - 0.5 * sense * axis.reversal_um +
                              axis.warm_up_um * (1.0 - std::exp(-t_s / 400.0)) + noise_um(random);
      record.Add(t_s, x_mm, x_mm + 1e-3 * error_um, sense, pass);
    }
  }
  return record;
}

TEST(EncoderTargets, ACurveThatRepeatsAtEveryTargetHidesNoReversal) {
  unsigned seed = 80;
  for (const Axis& axis : {Axis{400.0, 21, 94.0, 25.0, 0.8, 0.0}, Axis{240.0, 12, 60.0, 9.0, 0.6, 0.0}}) {
    const Answer answer = Ask(Positioned(axis, 10, ++seed));
    EXPECT_TRUE(answer.Names("backlash")) << answer.Words();
    EXPECT_NEAR(1e3 * answer.Value("backlash", "width"), axis.reversal_um,
                4e3 * answer.Uncertainty("backlash", "width"));
    EXPECT_LT(1e3 * answer.Uncertainty("backlash", "width"), 0.5);
    for (const char* needless : {"eccentricity", "ellipticity", "periodic", "signal_offset"})
      EXPECT_FALSE(answer.Names(needless, 0.1)) << answer.Words();
    EXPECT_EQ(answer.again.verdict, Verdict::kNone) << answer.Words();
  }
}

TEST(EncoderTargets, AWarmUpBesideTheReversalIsADriftThatSettles) {
  const Answer answer = Ask(Positioned({400.0, 21, 94.0, 25.0, 0.8, 15.0}, 10, 90));
  EXPECT_TRUE(answer.Names("backlash") && answer.Names("drift")) << answer.Words();
  EXPECT_NEAR(answer.Value("drift", "warm_up"), 400.0, 4.0 * answer.Uncertainty("drift", "warm_up"));
  EXPECT_NEAR(1e3 * answer.Value("backlash", "width"), 25.0, 4e3 * answer.Uncertainty("backlash", "width"));
  EXPECT_FALSE(answer.Names("hysteresis", 0.1)) << answer.Words();
  EXPECT_EQ(answer.again.verdict, Verdict::kNone) << answer.Words();
}

TEST(EncoderTargets, FewOrdersKeepTheirNames) {
  Record record;
  record.kind = "stops";
  std::mt19937_64 random(91);
  std::normal_distribution<double> noise(0.0, 0.001);
  for (int pass = 0; pass < 4; ++pass) {
    const int sense = pass % 2 == 0 ? 1 : -1;
    for (int k = 0; k < 24; ++k) {
      const double at_deg = 15.0 * (sense > 0 ? k : 23 - k), a = at_deg * units::deg;
      const double error_deg = 0.03 * std::cos(a + 0.7) + 0.012 * std::cos(5.0 * a) - 0.006 * sense;
      record.Add(4.0 * static_cast<double>(record.readings.size()), at_deg, at_deg + error_deg + noise(random),
                 sense, pass);
    }
  }
  const Answer answer = Ask(record);
  EXPECT_TRUE(answer.Find("eccentricity") && answer.Names("periodic") && answer.Names("backlash"))
      << answer.Words();
  EXPECT_EQ(answer.again.verdict, Verdict::kNone) << answer.Words();
}

}  // namespace
}  // namespace twinbench::diagnose::encoder
