#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "twin/diagnose/engine/noise_model.h"
#include "twin/diagnose/engine/projector.h"
#include "twin/diagnose/engine/scanner.h"

/// Explanations by the noise alone: heavy tails, single disturbed readings, correlation from reading to reading,
/// channels that are noisier than stated. A physical cause is never chosen with a noise model that the data refute.
namespace twinbench::diagnose {

/// One refuted property of the noise and how to repair it.
struct NoiseCause {
  enum class Kind { kTails, kOutliers, kCorrelation, kChannelScale };
  Kind kind = Kind::kTails;
  double log_bayes = 0.0;  // against white Gaussian noise of the stated deviations
  std::string words;       // "tails like Student's t with 5 degrees of freedom"
  NoiseModel repaired;
  std::vector<int> outliers;  // rows; kOutliers only
  double outlier_size = 0.0;  // rms of the largest of each reading, in units of noise
};

/// What is left of the data, whitened.
struct Rest {
  Eigen::VectorXd rows;
  Eigen::VectorXd redundancy;  // by row, the share of its own noise that is left; 0: it may be anything
};

/// What would be left if these rows might be anything.
using RestWithout = std::function<Rest(const std::vector<int>& rows)>;

/// Looks for refuted properties in what is left of the data.
///
/// @param rest  W y with accepted causes taken out, whitened with `noise`, and the diagonal of W.
/// @return best first; only those with a log Bayes factor above 1.
///
/// Single disturbed rows are found as in Baarda's data snooping: those farthest out are left out, the unknowns
/// adapt to the others, and again, until none is far; one row that is far off bends the fit for all that share its
/// unknowns. Reference: Baarda, A testing procedure for use in geodetic networks (1968).
std::vector<NoiseCause> FindNoiseCauses(const LinearRun& run, const NoiseModel& noise, const Rest& rest,
                                        const RestWithout& without);

}  // namespace twinbench::diagnose
