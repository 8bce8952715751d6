#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/diagnose/encoder_record.h"

// Resolvers whose signals are cut off and have every other fault as well, by the closed form of what they show.
namespace twinbench::diagnose::encoder {
namespace {

using namespace lab;

constexpr double kDegree = units::kPi / 180.0;

struct FaultyResolver {
  double level, zero_deg, offset_sin, offset_cos, mismatch, lead_deg, delay_s;

  double Shows_deg(double shaft_deg) const {
    const double p = (shaft_deg - zero_deg) * kDegree;
    const double sine = (1.0 + mismatch) * std::sin(p + lead_deg * kDegree) + offset_sin;
    const double cosine = std::cos(p) + offset_cos;
    const double shown_deg =
        zero_deg + std::atan2(std::clamp(sine, -level, level), std::clamp(cosine, -level, level)) / kDegree;
    return shown_deg + 360.0 * std::round((shaft_deg - shown_deg) / 360.0);
  }
};

/// A hand wheel to and fro.
Record OfResolver(const FaultyResolver& resolver, double noise_deg, unsigned seed) {
  const Swing swing{1100.0, 52.0};
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0.0, noise_deg);
  Record record;
  for (double t_s = 0.029; t_s < 78.0; t_s += 0.081)
    record.Add(t_s, swing.At(t_s), resolver.Shows_deg(swing.At(t_s - resolver.delay_s)) + noise(random),
               swing.Direction(t_s), swing.Pass(t_s));
  return record;
}

struct Expected {
  const char *effect, *parameter;
  double value, sharp;
};

/// Named, in its size, which is known as sharply as it has to be to be worth something; and the file says it all.
void ExpectAll(const Answer& answer, const std::vector<Expected>& all, const std::string& which) {
  for (const Expected& e : all) {
    EXPECT_TRUE(answer.Names(e.effect)) << which << " " << e.effect << ": " << answer.Words();
    const double u = answer.Uncertainty(e.effect, e.parameter);
    EXPECT_NEAR(answer.Value(e.effect, e.parameter), e.value, 4.0 * u) << which << " " << e.effect;
    EXPECT_LT(u, e.sharp) << which << " " << e.effect;
  }
  EXPECT_EQ(answer.again.verdict, Verdict::kNone) << which << ": " << answer.Words();
}

TEST(EncoderResolver, ThatIsClippedHasAllItsOtherFaultsAtOnceToo) {
  unsigned seed = 100;
  for (const double level : {0.3, 0.5, 0.7, 0.95}) {
    const FaultyResolver resolver{level, 23.0, 0.06, -0.045, 0.05, 3.0, 0.034};
    const Answer answer = Ask(OfResolver(resolver, 0.01, ++seed));
    ExpectAll(answer,
              {{"signal_clipping", "level", level, 3e-3},
               {"signal_offset", "offset_sin", 0.06, 3e-3},
               {"signal_offset", "offset_cos", -0.045, 3e-3},
               {"amplitude_mismatch", "ratio", 0.05, 3e-3},
               {"quadrature_error", "angle", 1e3 * 3.0 * kDegree, 3.0},
               {"latency", "delay", 0.034, 1e-3}},
              fmt::format("level {}", level));
    const double u_zero_deg = answer.Uncertainty("signal_clipping", "zero");
    EXPECT_NEAR(answer.Value("signal_clipping", "zero"), 23.0, 4.0 * u_zero_deg) << level;
    EXPECT_LT(u_zero_deg, 0.1);
  }
}

}  // namespace
}  // namespace twinbench::diagnose::encoder
