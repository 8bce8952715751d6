#include "tests/campaign/small_study.h"
#include "tests/core/input_error.h"
#include "tests/support/kept_text.h"
#include "twin/campaign/design.h"
#include "twin/campaign/trial.h"
#include "twin/campaign/variation.h"
#include "twin/core/scenario_uncertainty.h"

namespace twinbench::campaign {
namespace {

/// An autocollimator whose gain is known to 5 %: of errors of 6.6 arcsec that is several times what its noise
/// leaves.
constexpr const char* kStudy = R"(scenario_text = '''
bench = "turntable_autocollimator"
seed = 4
[turntable]
harmonics = [{ order = 1, amplitude_arcsec = 6.6, phase_deg = 40.0 }]
[turntable.random]
ez_arcsec = 0.0
[multitooth]
teeth = 360
tooth_rms_arcsec = 0.0
u_tooth_arcsec = 0.0
[autocollimator]
noise_arcsec = 0.05
u_gain_error = 0.05
[turntable_procedure]
phases = ["full_circle"]
positions = 12
shifts_teeth = [0]
'''
)";
constexpr int kTrials = 100;

struct Normed {
  double mean_square = 0.0;  // of error / u
  double rms_u = 0.0;        // [arcsec]
};

Normed NormedErrors(const Study& study) {
  const Design design(study);
  Normed sum;
  int count = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const TrialRow row = RunTrial(study, design, trial);
    EXPECT_EQ(row.failure, "");
    for (const TrialResult& r : row.results) {
      if (!r.name.starts_with("score.turntable.ez_arcsec")) continue;
      sum.mean_square += std::pow(r.error / r.u, 2);
      sum.rms_u += r.u * r.u;
      ++count;
    }
  }
  return {sum.mean_square / count, std::sqrt(sum.rms_u / count)};
}

TEST(Standards, AreDrawnInTheTwinAndCountedInTheStatedUncertainty) {
  const Normed without = NormedErrors(ParseStudy(kStudy, "study.toml", ""));
  const Normed with = NormedErrors(ParseStudy(std::string(kStudy) + "standards = true\n", "study.toml", ""));
  // One draw of the gain moves all positions of a trial: chi square with one degree of freedom, +-14 % for 100
  // trials.
  EXPECT_NEAR(with.mean_square, 1.0, 0.5);
  const double gain_arcsec = 0.05 * 6.6 * std::sqrt(0.5);
  EXPECT_NEAR(with.rms_u, std::hypot(without.rms_u, gain_arcsec), 0.1 * with.rms_u);
}

TEST(Standards, AreInTheTwinOfATrialAsTheyWereDrawn) {
  const Study study = ParseStudy(std::string(kStudy) + "standards = true\ntrials = 100\n", "study.toml", "");
  const Design design(study);
  const auto gain_error = [&](std::int64_t trial) {
    Scenario scenario = TwinOf(study, design, trial);
    return NumbersAt(scenario, "autocollimator.gain_error")[0];
  };
  double squares = 0.0;
  for (int trial = 0; trial < kTrials; ++trial) squares += std::pow(gain_error(trial), 2);
  EXPECT_NEAR(std::sqrt(squares / kTrials), 0.05, 4.0 * 0.05 / std::sqrt(2.0 * kTrials));
  EXPECT_EQ(gain_error(7), gain_error(7));
  EXPECT_NE(gain_error(7), gain_error(8));
}

TEST(Standards, AreRefusedWhereTheScenarioStatesNone) {
  EXPECT_KEPT(MessageOf([] { ParseStudy(StudyOf("standards = true\n"), "study.toml", ""); }));
}

Design DesignOf(const std::string& lines) { return Design(ParseStudy(StudyOf(lines), "study.toml", "")); }

constexpr const char* kTwoUniform = R"([[vary]]
key = "device.noise_deg"
distribution = "uniform"
lower = 0.001
upper = 0.003
[[vary]]
key = "encoder_procedure.start_deg"
distribution = "uniform"
lower = 0.0
upper = 10.0
)";

TEST(Design, CombinesGridsWithTheLastChangingFastest) {
  const Design design = DesignOf(R"(trials = 2
[[vary]]
key = "device.noise_deg"
values = [0.001, 0.002]
[[vary]]
key = "encoder_procedure.stops_per_turn"
from = 24
to = 48
n = 3
)");
  ASSERT_EQ(design.Trials(), 12);
  using testing::ElementsAre;
  for (int trial = 0; trial < 12; ++trial) {
    const char* stops[] = {"24", "24", "36", "36", "48", "48"};
    EXPECT_THAT(design.ValuesOf(trial), ElementsAre(trial < 6 ? "0.001" : "0.002", stops[trial % 6])) << trial;
  }
}

TEST(Design, HitsEveryStratumOfALatinHypercubeOnce) {
  const Design design = DesignOf("trials = 50\nsampling = \"latin_hypercube\"\n" + std::string(kTwoUniform));
  std::set<int> noise, start;
  bool same_order = true;
  for (std::int64_t trial = 0; trial < design.Trials(); ++trial) {
    const auto values = design.ValuesOf(trial);
    const int a = static_cast<int>((std::stod(values[0]) - 0.001) / 0.002 * 50.0);
    const int b = static_cast<int>(std::stod(values[1]) / 10.0 * 50.0);
    noise.insert(a);
    start.insert(b);
    same_order = same_order && a == b;
  }
  EXPECT_EQ(noise.size(), 50u);
  EXPECT_EQ(start.size(), 50u);
  EXPECT_FALSE(same_order) << "both keys go through their strata in one order";
}

TEST(Design, SamplesEachKeyIndependently) {
  const Design design = DesignOf("trials = 2000\n" + std::string(kTwoUniform));
  double sum_a = 0.0, sum_b = 0.0, sum_ab = 0.0;
  for (std::int64_t trial = 0; trial < 2000; ++trial) {
    const auto values = design.ValuesOf(trial);
    const double a = (std::stod(values[0]) - 0.001) / 0.002 - 0.5, b = std::stod(values[1]) / 10.0 - 0.5;
    sum_a += a;
    sum_b += b;
    sum_ab += a * b;
  }
  // Standard deviations of the means: sqrt(1/12/2000) = 0.0065 and (1/12)/sqrt(2000) = 0.0019; four of them.
  EXPECT_NEAR(sum_a / 2000, 0.0, 0.026);
  EXPECT_NEAR(sum_b / 2000, 0.0, 0.026);
  EXPECT_NEAR(sum_ab / 2000, 0.0, 0.0076);
}

TEST(Design, TellsWhatIsHiddenToTheTwinAlone) {
  const Design design = DesignOf(R"([[vary]]
key = "device.noise_deg"
values = [0.002]
[[vary]]
key = "title"
hidden = true
values = ["secret"]
)");
  const std::string seed = "seed=\"" + std::to_string(design.SeedOf(0)) + "\"";
  EXPECT_THAT(design.OverridesOf(0), testing::ElementsAre("device.noise_deg=0.002", "title=secret", seed));
  EXPECT_THAT(design.BelievedOf(0), testing::ElementsAre("device.noise_deg=0.002", seed));
}

TEST(Design, GivesATrialTheSameWhereverTheStudyEndsAndASeedOfItsOwn) {
  const Design few = DesignOf("trials = 3\n" + std::string(kTwoUniform));
  const Design many = DesignOf("trials = 300\n" + std::string(kTwoUniform));
  for (std::int64_t trial = 0; trial < 3; ++trial) EXPECT_EQ(few.OverridesOf(trial), many.OverridesOf(trial));
  const Design one = DesignOf("trials = 1000\nseed = 1\n"), other = DesignOf("trials = 1000\nseed = 2\n");
  std::set<std::uint64_t> seeds;
  for (std::int64_t trial = 0; trial < 1000; ++trial) seeds.insert({one.SeedOf(trial), other.SeedOf(trial)});
  EXPECT_EQ(seeds.size(), 2000u);
}

struct Moments {
  double mean = 0.0, variance = 0.0;
};

/// By the midpoint rule over probability: E[f(X)] is the integral of f(Quantile(p)) over p from 0 to 1.
Moments MomentsOf(const Distribution& distribution) {
  constexpr int kSteps = 200000;
  Moments m;
  double squares = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double x = Quantile(distribution, (i + 0.5) / kSteps);
    m.mean += x / kSteps;
    squares += x * x / kSteps;
  }
  m.variance = squares - m.mean * m.mean;
  return m;
}

TEST(Distributions, HaveTheirMeansAndVariances) {
  const double a = -1.0, c = 0.5, b = 4.0, least = 0.01, most = 10.0, log = std::log(most / least);
  const double mean = (most - least) / log;
  struct Row {
    Distribution distribution;
    double mean, variance, tolerance;
  };
  // The tails of the normal distribution beyond the outermost midpoint hold less than 1e-4 of its variance; the
  // others are bounded and the rule is exact to 1e-9 of their squares.
  const Row rows[] = {
      {Normal{3.0, 0.5}, 3.0, 0.25, 0.25 * 2e-4},
      {Uniform{-1.0, 5.0}, 2.0, 36.0 / 12.0, 1e-6},
      {Triangular{a, c, b}, (a + b + c) / 3.0, (a * a + b * b + c * c - a * b - a * c - b * c) / 18.0, 1e-6},
      {LogUniform{least, most}, mean, (most * most - least * least) / (2.0 * log) - mean * mean, 1e-5}};
  for (const Row& row : rows) {
    const Moments m = MomentsOf(row.distribution);
    EXPECT_NEAR(m.mean, row.mean, 1e-6) << row.mean;
    EXPECT_NEAR(m.variance, row.variance, row.tolerance) << row.mean;
  }
}

TEST(Distributions, HaveTheirQuantilesATriangleAlsoWithItsModeAtAnEnd) {
  EXPECT_NEAR(Quantile(Normal{0.0, 1.0}, 0.975), 1.959963984540054, 1e-12);
  EXPECT_NEAR(Quantile(Normal{0.0, 1.0}, 0.025), -1.959963984540054, 1e-12);
  EXPECT_NEAR(Quantile(Triangular{0.0, 0.0, 1.0}, 0.75), 0.5, 1e-14);  // 1 - (1 - x)^2 = 0.75
  EXPECT_NEAR(Quantile(Triangular{0.0, 1.0, 1.0}, 0.25), 0.5, 1e-14);  // x^2 = 0.25
}

}  // namespace
}  // namespace twinbench::campaign
