#include "twin/benches/freeform_five_axis/estimators/volumetric.h"

#include <algorithm>

#include "twin/benches/freeform_five_axis/estimators/published.h"
#include "twin/core/linear_algebra.h"
#include "twin/core/stream.h"

namespace twinbench::benches::freeform::estimators {

Eigen::MatrixXd ColumnsWithoutRigidMotion(const Eigen::Matrix3Xd& points, const Eigen::MatrixXd& vectors) {
  const Eigen::Vector3d middle = points.rowwise().mean();
  Eigen::MatrixXd motion(3 * points.cols(), 6);
  for (Eigen::Index k = 0; k < points.cols(); ++k) {
    const Eigen::Vector3d p = points.col(k) - middle;
    Eigen::Matrix3d turned;  // p x e of each axis, negative: a turn moves p by turn x p
    turned << 0.0, p.z(), -p.y(), -p.z(), 0.0, p.x(), p.y(), -p.x(), 0.0;
    motion.middleRows(3 * k, 3) << Eigen::Matrix3d::Identity(), turned;
  }
  constexpr double kRank = 1e-12;
  return vectors - motion * SolveRanked(motion, vectors, kRank).x;
}

Eigen::Matrix3Xd WithoutRigidMotion(const Eigen::Matrix3Xd& points, const Eigen::Matrix3Xd& vectors) {
  return ColumnsWithoutRigidMotion(points, vectors.reshaped()).reshaped(3, points.cols());
}

std::vector<PoseRead> UnseenPoses(const std::vector<PoseRead>& seen, const FreeformSettings& bench, int count) {
  Stream random(1, "score.unseen_poses");
  std::vector<PoseRead> poses(static_cast<std::size_t>(count));
  for (std::size_t axis = 0; axis < kMachineAxes; ++axis) {
    const auto [low, high] = std::ranges::minmax(seen, {}, [axis](const PoseRead& p) { return p.at[axis]; });
    for (PoseRead& pose : poses) {
      pose.at[axis] = low.at[axis] + random.Uniform() * (high.at[axis] - low.at[axis]);
      pose.t[axis] = (pose.at[axis] - bench.machine.centre[axis]) / bench.machine.half[axis];
    }
  }
  return poses;
}

namespace {

PoseRead PoseAt(const std::array<double, kMachineAxes>& at, const FreeformSettings& bench) {
  PoseRead pose;
  pose.at = at;
  for (std::size_t axis = 0; axis < kMachineAxes; ++axis)
    pose.t[axis] = (at[axis] - bench.machine.centre[axis]) / bench.machine.half[axis];
  return pose;
}

}  // namespace

std::vector<Grid> GridsOf(const std::vector<PoseRead>& seen, const FreeformSettings& bench, int nodes_an_axis) {
  std::array<double, kMachineAxes> low{}, high{};
  for (std::size_t axis = 0; axis < kMachineAxes; ++axis) {
    const auto [least, most] = std::ranges::minmax(seen, {}, [axis](const PoseRead& p) { return p.at[axis]; });
    low[axis] = least.at[axis];
    high[axis] = most.at[axis];
  }
  const auto node = [&](std::size_t axis, int k) {
    return low[axis] + (high[axis] - low[axis]) * k / (nodes_an_axis - 1);
  };
  std::vector<Grid> grids;
  for (const auto& [share_a, share_b] : {std::pair{0.0, 0.0}, {0.5, 0.0}, {0.0, 0.5}, {0.5, 0.5}}) {
    Grid& grid = grids.emplace_back(Grid{share_a * high[3], share_b * high[4], {}});
    for (int i = 0; i < nodes_an_axis; ++i) {
      for (int j = 0; j < nodes_an_axis; ++j) {
        for (int k = 0; k < nodes_an_axis; ++k)
          grid.poses.push_back(PoseAt({node(0, i), node(1, j), node(2, k), grid.a_rad, grid.b_rad}, bench));
      }
    }
  }
  return grids;
}

std::vector<PoseRead> PosesOnGrids(const std::vector<Grid>& grids) {
  std::vector<PoseRead> poses;
  for (const Grid& grid : grids) poses.insert(poses.end(), grid.poses.begin(), grid.poses.end());
  return poses;
}

Eigen::Matrix3Xd Tips_um(const FreeformSettings& bench, const std::vector<PoseRead>& poses,
                         const Eigen::VectorXd& unknowns, Estimator estimator) {
  const bool is_published = estimator == Estimator::kPublished;
  Eigen::Matrix3Xd tips(3, std::ssize(poses));
  for (std::size_t p = 0; p < poses.size(); ++p) {
    const Inputs inputs = is_published ? Inputs(Inputs::Zero()) : InputsAt(poses[p], unknowns);
    tips.col(static_cast<Eigen::Index>(p)) = Tip_m(bench, poses[p], inputs) / units::um;
  }
  return is_published ? Eigen::Matrix3Xd(tips + PublishedErrors_um(poses, unknowns)) : tips;
}

namespace {

/// By all unknowns of the machine, each a um or an arcsec.
Eigen::MatrixXd SlopesOfTips_um(const FreeformSettings& bench, const std::vector<PoseRead>& poses, const Identification& found,
                                Estimator estimator) {
  if (estimator == Estimator::kRigorous) return TipSlopes_um(bench, poses, found.unknowns);
  Eigen::MatrixXd slopes(3 * std::ssize(poses), kOfMachine);
  for (Eigen::Index k = 0; k < kOfMachine; ++k) {
    const Eigen::VectorXd one = Eigen::VectorXd::Unit(found.unknowns.size(), k);
    slopes.col(k) = 0.5 * (Tips_um(bench, poses, found.unknowns + one, estimator) - Tips_um(bench, poses, found.unknowns - one, estimator)).reshaped();
  }
  return slopes;
}

}  // namespace

VolumetricErrors PredictErrorsAlone(const FreeformSettings& bench, const std::vector<PoseRead>& poses,
                                    const Identification& found, Estimator estimator) {
  const auto tips = [&](const Eigen::VectorXd& x) { return Tips_um(bench, poses, x, estimator); };
  VolumetricErrors errors;
  errors.nominal_um = tips(Eigen::VectorXd::Zero(found.unknowns.size()));
  errors.error_um = WithoutRigidMotion(errors.nominal_um, tips(found.unknowns) - errors.nominal_um);
  return errors;
}

VolumetricErrors PredictErrors(const FreeformSettings& bench, const std::vector<PoseRead>& poses,
                               const Identification& found, Estimator estimator) {
  VolumetricErrors errors = PredictErrorsAlone(bench, poses, found, estimator);
  const Eigen::MatrixXd slopes = ColumnsWithoutRigidMotion(errors.nominal_um, SlopesOfTips_um(bench, poses, found, estimator));
  const Eigen::MatrixXd covariance = found.covariance.topLeftCorner(kOfMachine, kOfMachine);
  const SymmetricEigen eigen = EigenOfSymmetric(covariance);
  errors.root_um = slopes * eigen.vectors * eigen.values.cwiseMax(0.0).cwiseSqrt().asDiagonal();
  errors.u_um = errors.root_um.rowwise().norm().reshaped(3, std::ssize(poses));
  return errors;
}

}  // namespace twinbench::benches::freeform::estimators
