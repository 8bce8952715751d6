#include "twin/benches/freeform_five_axis/estimators/published.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace twinbench::benches::freeform::estimators {
namespace {

using Eigen::Vector3d;

constexpr double kTurn_um_m = units::arcsec / units::um;  // what an arcsec moves at a metre

enum Axis { kX, kY, kZ, kA, kB };
enum Error { kTx, kTy, kTz, kRx, kRy, kRz };
enum Squareness { kSyx, kSzx, kSzy };

/// Eqs 1 to 3 for one pose: 3 x unknowns, in um.
class Equations {
 public:
  Equations(const PoseRead& pose, Eigen::Index unknowns) : pose_(pose), rows_(Eigen::MatrixXd::Zero(3, unknowns)) {
    const auto& [x_m, y_m, z_m, a_rad, b_rad] = pose.at;
    const double cos_a = std::cos(a_rad), sin_a = std::sin(a_rad), cos_b = std::cos(b_rad), sin_b = std::sin(b_rad);
    const Vector3d on_work_m(-x_m, y_m, z_m);
    for (int k = 0; k < 3; ++k) {
      Add(kX, kTx + k, -Vector3d::Unit(k));
      Add(kY, kTx + k, Vector3d::Unit(k));
      Add(kZ, kTx + k, Vector3d::Unit(k));
      Add(kX, kRx + k, on_work_m.cross(Vector3d::Unit(k)) * kTurn_um_m);
    }
    Add(kY, kRy, Vector3d(z_m, 0.0, 0.0) * kTurn_um_m);
    Add(kY, kRx, Vector3d(0.0, -z_m, 0.0) * kTurn_um_m);
    Add(kA, kTx, {1.0, 0.0, 0.0});
    Add(kA, kTy, {0.0, cos_a, sin_a});
    Add(kA, kTz, {0.0, 0.0, cos_a});
    Add(kB, kTx, {cos_b, sin_a * sin_b, -cos_a * sin_b});
    Add(kB, kTy, {0.0, cos_a, sin_a});
    Add(kB, kTz, {sin_b, -cos_b * sin_a, 0.0});
    rows_.col(SquarenessAt(kSyx)) = Vector3d(-y_m, 0.0, 0.0) * kTurn_um_m;
    rows_.col(SquarenessAt(kSzx)) = Vector3d(z_m, 0.0, 0.0) * kTurn_um_m;
    rows_.col(SquarenessAt(kSzy)) = Vector3d(0.0, -z_m, 0.0) * kTurn_um_m;
  }

  /// What a set-up's place adds: the artefact's motion, backwards.
  void AddMounting(const MountSettings& mount) {
    const Eigen::AngleAxisd yaw(mount.yaw_rad, Vector3d::UnitZ());
    const Vector3d from_mount_m =
        Vector3d(-pose_.at[0], pose_.at[1], pose_.at[2]) - Vector3d(mount.x_m, mount.y_m, mount.z_m);
    for (int k = 0; k < 3; ++k) {
      const Vector3d axis = yaw * Vector3d::Unit(k);
      rows_.col(MountingAt(pose_.setup, kTx + k)) = -axis;
      rows_.col(MountingAt(pose_.setup, kRx + k)) = -axis.cross(from_mount_m) * kTurn_um_m;
    }
  }

  const Eigen::MatrixXd& rows() const { return rows_; }

 private:
  void Add(int axis, int error, const Vector3d& moves) {
    double power = 1.0;
    for (int term = 0; term < kCubicTerms; ++term) {
      rows_.col(CubicAt(axis, error, term)) += power * moves;
      power *= pose_.t[static_cast<std::size_t>(axis)];
    }
  }

  const PoseRead& pose_;
  Eigen::MatrixXd rows_;
};

/// The same quadrants for the patent, which has no gap and takes all light for what it gets.
QuadrantSettings WithoutGap(QuadrantSettings qpd) {
  qpd.gap_m = 0.0;
  return qpd;
}

/// Distance from the tip to the surface.
double Height_m(double px, const CameraSettings& ccd) {
  const double alpha = ccd.alpha_rad;
  const double beta = std::atan(ccd.object_m * std::tan(alpha) / ccd.image_m);
  const double s_m = (px - ccd.centre_px) * ccd.pixel_m;
  return s_m * ccd.object_m * std::sin(beta) / (ccd.image_m * std::sin(alpha) - s_m * std::sin(alpha + beta));
}

/// The patent's three co-ordinates of a reading in the probe's frame [m]: constant sensitivity R / (2 f) of the
/// spot, and the height.
Vector3d ProbeCoordinates_m(const Vector3d& shown, const PoseRead& pose, const FreeformSettings& bench) {
  const double radius_m = bench.artefact.vertex_radius_m[(pose.i + pose.j) % 2 == 0 ? 0 : 1];
  const double scale = -radius_m / (2.0 * bench.qpd.lens_m);
  return {scale * SpotAt_m(shown[0] / bench.qpd.sum_V, WithoutGap(bench.qpd)),
          scale * SpotAt_m(shown[1] / bench.qpd.sum_V, WithoutGap(bench.qpd)), Height_m(shown[2], bench.ccd)};
}

/// Displacement against the ideal machine at that pose, in the machine's axes [um].
Vector3d Displacement_um(const PoseRead& pose, const FreeformSettings& bench) {
  const Vector3d ideal = Predicted(bench, pose, Inputs::Zero());
  const Vector3d in_probe_m = ProbeCoordinates_m(pose.shown, pose, bench) - ProbeCoordinates_m(ideal, pose, bench);
  return Eigen::AngleAxisd(pose.at[3], Vector3d::UnitX()) *
         (Eigen::AngleAxisd(pose.at[4], Vector3d::UnitY()) * in_probe_m) / units::um;
}

}  // namespace

Identification IdentifyPublished(const FreeformSettings& bench, const std::vector<PoseRead>& poses) {
  const int setups = SetupsOf(poses);
  const Eigen::Index unknowns = MountingAt(setups, 0);
  Eigen::MatrixXd jacobian(3 * std::ssize(poses), unknowns);
  Eigen::VectorXd seen_um(jacobian.rows());
  const std::vector<MountSettings>& mounts = bench.freeform_procedure.mounts;
  for (std::size_t p = 0; p < poses.size(); ++p) {
    Equations equations(poses[p], unknowns);
    const auto setup = static_cast<std::size_t>(poses[p].setup);
    equations.AddMounting(setup < mounts.size() ? mounts[setup] : MountSettings{});
    jacobian.middleRows<3>(3 * static_cast<Eigen::Index>(p)) = equations.rows();
    seen_um.segment<3>(3 * static_cast<Eigen::Index>(p)) = Displacement_um(poses[p], bench);
  }
  Identification found = SolveLinear(jacobian, Eigen::VectorXd::Ones(seen_um.size()), seen_um, setups);
  // u as for displacements of one um: the patent states none. What they scatter by takes its place.
  const double rms_um = (seen_um - jacobian * found.unknowns).norm() /
                        std::sqrt(static_cast<double>(std::max<Eigen::Index>(1, found.dof)));
  found.u *= rms_um;
  found.covariance *= rms_um * rms_um;
  SetResiduals(bench, poses, found);
  return found;
}

Eigen::Matrix3Xd PublishedErrors_um(const std::vector<PoseRead>& poses, const Eigen::VectorXd& unknowns) {
  Eigen::Matrix3Xd errors(3, std::ssize(poses));
  for (std::size_t p = 0; p < poses.size(); ++p)
    errors.col(static_cast<Eigen::Index>(p)) = Equations(poses[p], unknowns.size()).rows() * unknowns;
  return errors;
}

}  // namespace twinbench::benches::freeform::estimators
