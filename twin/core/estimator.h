#pragma once

#include <string>

namespace twinbench {

/// How readings become errors: kPublished as the bench's paper prints it, for comparison; kRigorous by the exact
/// model of the bench.
enum class Estimator { kPublished, kRigorous };

/// "published", "rigorous"
inline const char* EstimatorName(Estimator estimator) {
  return estimator == Estimator::kPublished ? "published" : "rigorous";
}

/// The estimator of that name; kRigorous if it is neither.
inline Estimator EstimatorNamed(const std::string& name) {
  return name == EstimatorName(Estimator::kPublished) ? Estimator::kPublished : Estimator::kRigorous;
}

}  // namespace twinbench
