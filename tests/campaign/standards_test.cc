#include <gmock/gmock.h>

#include <cmath>

#include "tests/campaign/small_study.h"
#include "tests/core/input_error.h"
#include "tests/support/kept_text.h"
#include "twin/campaign/trial.h"
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

}  // namespace
}  // namespace twinbench::campaign
