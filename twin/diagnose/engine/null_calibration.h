#pragma once

#include <string>
#include <vector>

#include "twin/diagnose/engine/scanner.h"

namespace twinbench::diagnose {

/// How large the alarm statistic gets when there is no effect, by simulation on one design.
struct NullCalibration {
  std::vector<double> sorted;  // alarm statistics of the simulated runs, ascending

  /// The statistic that is exceeded with this probability. Beyond the simulated runs an exponential tail is fitted
  /// to the top tenth: a Bayes factor above x has a probability of at most 1 / x (Markov).
  double Threshold(double probability) const;

  /// Probability of so large a statistic with no effect.
  double PValue(double statistic) const;
};

/// Simulates `runs` clean runs with noise of this design's deviations, white but for what all channels of a reading share
/// (LinearRun::draws).
NullCalibration Calibrate(const LinearRun& run, const Scanner& scanner, const Projector& projector,
                          const Eigen::VectorXd& log_priors, int runs);

/// The same, kept in a file of `folder` by `key`; an empty folder keeps nothing, an unwritable one is no error.
NullCalibration CalibrateCached(const LinearRun& run, const Scanner& scanner, const Projector& projector,
                                const Eigen::VectorXd& log_priors, int runs, const std::string& folder,
                                const std::string& key);

/// Identifies designs whose thresholds agree: kind and order of the readings and the families, not the exact times.
std::string DesignKey(const LinearRun& run, const std::vector<Family>& families, int runs);

}  // namespace twinbench::diagnose
