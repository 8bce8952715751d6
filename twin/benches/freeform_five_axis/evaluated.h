#pragma once

#include <nlohmann/json_fwd.hpp>

#include "twin/benches/freeform_five_axis/estimators/volumetric.h"
#include "twin/core/scenario.h"

namespace twinbench::report {
struct ScoredRun;
}

namespace twinbench::benches::freeform {

/// Poses of the readings that have every value.
/// @throws InputError if they are fewer than 12.
std::vector<estimators::PoseRead> SeenPoses(const Scenario& scenario, const std::vector<Reading>& readings);

estimators::Identification IdentifyBy(const FreeformSettings& bench, const std::vector<estimators::PoseRead>& poses,
                                      Estimator estimator);

/// Poses and what was identified by them against the truth of a run.
report::ScoredRun ScoreOf(const FreeformSettings& bench, const std::vector<estimators::PoseRead>& seen,
                          const estimators::Identification& found, const nlohmann::json& truth, Estimator estimator);

/// Root mean square of the lengths of columns.
double RmsLength(const Eigen::Matrix3Xd& vectors);

/// What the published equations do to the map of the tip's errors beyond the noise: against the rigorous
/// identification of the same readings, component by component, rms over the poses.
struct MapBias {
  Eigen::Vector3d rms_um = Eigen::Vector3d::Zero(), u_noise_um = Eigen::Vector3d::Zero();
  bool IsBiased(Eigen::Index component) const { return rms_um[component] > 2.0 * u_noise_um[component]; }
};

/// A published map with that in its uncertainty.
struct PublishedMap {
  estimators::VolumetricErrors errors;
  MapBias bias;
};
PublishedMap PredictPublished(const FreeformSettings& bench, const std::vector<estimators::PoseRead>& poses,
                              const estimators::Identification& published,
                              const estimators::Identification& rigorous);

}  // namespace twinbench::benches::freeform
