#include "twin/benches/freeform_five_axis/evaluated.h"

#include <fmt/format.h>

#include <cmath>

#include "twin/benches/freeform_five_axis/estimators/published.h"
#include "twin/core/errors.h"

namespace twinbench::benches::freeform {

std::vector<estimators::PoseRead> SeenPoses(const Scenario& scenario, const std::vector<Reading>& readings) {
  constexpr std::size_t kFewest = 12;
  std::vector<estimators::PoseRead> poses = estimators::PosesOf(readings, FreeformOf(scenario));
  if (poses.size() < kFewest)
    throw InputError("readings", fmt::format("{} of {} have a value", poses.size(), readings.size()),
                     fmt::format("at least {}", kFewest));
  return poses;
}

estimators::Identification IdentifyBy(const FreeformSettings& bench, const std::vector<estimators::PoseRead>& poses,
                                      Estimator estimator) {
  return estimator == Estimator::kPublished ? estimators::IdentifyPublished(bench, poses)
                                            : estimators::Identify(bench, poses);
}

double RmsLength(const Eigen::Matrix3Xd& vectors) {
  return vectors.norm() / std::sqrt(static_cast<double>(vectors.cols()));
}

}  // namespace twinbench::benches::freeform
