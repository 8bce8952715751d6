#include "twin/benches/freeform_five_axis/evaluated.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

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

PublishedMap PredictPublished(const FreeformSettings& bench, const std::vector<estimators::PoseRead>& poses,
                              const estimators::Identification& published,
                              const estimators::Identification& rigorous) {
  PublishedMap map{estimators::PredictErrors(bench, poses, published, Estimator::kPublished), {}};
  const estimators::VolumetricErrors exact =
      estimators::PredictErrors(bench, poses, rigorous, Estimator::kRigorous);
  const auto rms = [](const Eigen::Matrix3Xd& m) -> Eigen::Vector3d {
    return m.rowwise().norm() / std::sqrt(static_cast<double>(m.cols()));
  };
  map.bias.rms_um = rms(map.errors.error_um - exact.error_um);
  // The published u is from what the equations leave over, which is more than noise: the rigorous one is noise.
  map.bias.u_noise_um = std::numbers::sqrt2 * rms(exact.u_um);
  for (Eigen::Index c = 0; c < 3; ++c)
    map.errors.u_um.row(c) = (map.errors.u_um.row(c).array().square() + std::pow(map.bias.rms_um[c], 2)).sqrt();
  return map;
}

}  // namespace twinbench::benches::freeform
