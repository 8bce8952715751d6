#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "twin/diagnose/engine/linear_run.h"
#include "twin/diagnose/engine/noise_model.h"

/// Residual tests: where a run and its model disagree. They show and do not decide. Reference: docs/diagnosis.md.
namespace twinbench::diagnose {

struct ResidualTest {
  std::string name;
  double statistic = kNaN;  // by the test's textbook definition; of several channels or groupings that of the worst
  double p = kNaN;          // probability that noise alone deviates as much, in whichever of them
  double effect_m = kNaN;   // size of what was found; NaN where a size has no meaning or readings are angles
  double effect_rad = kNaN;  // the same as an angle: of the rotation that moves the channel most
  std::string reading;       // what it means physically, in words; says so if it is not beyond noise (p > 0.05)
  std::vector<std::string> tables;  // one line a channel or grouping, the worst ones first
};

/// Fit to stated noise, runs and autocorrelation, periodogram, normality, variance by group; one that does not
/// apply is absent. A simulation without noise has none.
///
/// p is simulated: runs of normal noise on the same design go through the same free unknowns and the same tests
/// (Barnard 1963). All but the first judge each channel by its own scatter, so that a wrong noise figure is told
/// once.
///
/// @param noise      As repaired so far; its sigma whitens the run.
/// @param null_runs  Simulated runs, at least 50; 0: 300, down to 150 in runs of more than 6700 rows, whose cost is
///                   rows x null_runs. p below a tenth comes from an exponential fitted to the largest of them.
std::vector<ResidualTest> TestResiduals(const LinearRun& run, const NoiseModel& noise, int null_runs = 0,
                                        std::uint64_t seed = 1);

/// In how many runs without any effect one residual test or more stands out.
inline constexpr double kResidualFalseAlarms = 0.01;

/// The tests whose p is below kResidualFalseAlarms shared by all of them (Bonferroni), least probable first.
std::vector<ResidualTest> StandingOut(std::vector<ResidualTest> tests);

/// Those in a plain paragraph; says so if there are none.
std::string ResidualTestsInWords(const std::vector<ResidualTest>& tests);

}  // namespace twinbench::diagnose
