#include "twin/benches/freeform_five_axis/estimators/probe_model.h"

#include <algorithm>
#include <cmath>

#include "twin/benches/freeform_five_axis/columns.h"

namespace twinbench::benches::freeform::estimators {
namespace {

using Eigen::Matrix3d, Eigen::Vector3d;

struct SinCos {
  double sin, cos;
};

/// Errors are angles so small that the next term of the series is below the last digit.
SinCos SinCosOf(double angle) {
  constexpr double kSmall = 1e-3;
  if (std::abs(angle) > kSmall) return {std::sin(angle), std::cos(angle)};
  const double square = angle * angle;
  return {angle * (1.0 - square / 6.0 * (1.0 - square / 20.0)), 1.0 - 0.5 * square * (1.0 - square / 12.0 * (1.0 - square / 30.0))};
}

/// Rz(z) Ry(y) Rx(x), multiplied out.
Matrix3d Turn(double x, double y, double z) {
  const auto [sx, cx] = SinCosOf(x);
  const auto [sy, cy] = SinCosOf(y);
  const auto [sz, cz] = SinCosOf(z);
  Matrix3d R;
  R << cz * cy, cz * sy * sx - sz * cx, cz * sy * cx + sz * sx,  //
      sz * cy, sz * sy * sx + cz * cx, sz * sy * cx - cz * sx,   //
      -sy, cy * sx, cy * cx;
  return R;
}

/// A point and the directions of the tool, in the frame of whichever body they have been carried to.
struct Carried {
  Vector3d point;
  Matrix3d axes = Matrix3d::Identity();

  void Rotate(const Matrix3d& R) {
    point = R * point;
    axes = R * axes;
  }
  void IntoParent(const double* error) {  // of a body: tx, ty, tz, rx, ry, rz
    Rotate(Turn(error[3], error[4], error[5]));
    point += Vector3d(error[0], error[1], error[2]);
  }
  void IntoChild(const double* error) {
    point -= Vector3d(error[0], error[1], error[2]);
    Rotate(Turn(error[3], error[4], error[5]).transpose());
  }
};

/// The tool in the X slide's frame.
Carried OnSlide(const FreeformSettings& bench, const PoseRead& pose, const Inputs& e) {
  const double* const body = e.data();
  const double* const s = body + kMachineAxes * kBodyErrors;  // syx szx szy say saz sbx sbz
  const Matrix3d S_a = Turn(0.0, s[3], 0.0), Z_a = Turn(0.0, 0.0, s[4]);
  const Matrix3d S_b = Turn(0.0, 0.0, s[6]) * Turn(s[5], 0.0, 0.0);
  const double pivot_m = bench.machine.pivot_m;
  Carried tool{Vector3d(0.0, 0.0, -pivot_m)};
  tool.IntoParent(body + 24);
  tool.Rotate(S_b * Turn(0.0, pose.at[4], 0.0) * S_b.transpose());
  tool.IntoParent(body + 18);
  tool.Rotate(Z_a * S_a * Turn(pose.at[3], 0.0, 0.0) * S_a.transpose() * Z_a.transpose());
  tool.point.z() += pivot_m;
  tool.IntoParent(body + 12);
  // Ry(szx) Rx(szy) z and Rz(syx) y, multiplied out.
  tool.point +=
      pose.at[2] * Vector3d(std::sin(s[1]) * std::cos(s[2]), -std::sin(s[2]), std::cos(s[1]) * std::cos(s[2]));
  tool.IntoParent(body + 6);
  tool.point += pose.at[1] * Vector3d(-std::sin(s[0]), std::cos(s[0]), 0.0);
  tool.point.x() -= pose.at[0];
  tool.IntoChild(body);
  return tool;
}

/// How far the beam goes from `from` along `beam` until it meets z = (x^2 + y^2) / (2 R).
double Distance_m(const Vector3d& from, const Vector3d& beam, double radius_m) {
  constexpr int kSteps = 6;  // each doubles the digits
  double distance_m = 0.0;
  for (int step = 0; step < kSteps; ++step) {
    const Vector3d p = from + distance_m * beam;
    const double above_m = p.z() - p.head<2>().squaredNorm() / (2.0 * radius_m);
    const double closing = beam.z() - p.head<2>().dot(beam.head<2>()) / radius_m;
    distance_m -= above_m / closing;
  }
  return distance_m;
}

/// Share of a Gaussian spot on one side minus the other, and on both.
Eigen::Vector2d Balance(double at_m, const QuadrantSettings& qpd) {
  const double k = std::sqrt(2.0) / qpd.spot_radius_m;
  const double upper = std::erf(k * (at_m - 0.5 * qpd.gap_m)), lower = std::erf(k * (at_m + 0.5 * qpd.gap_m));
  return {0.5 * (upper + lower), 1.0 + 0.5 * (upper - lower)};
}

double CameraPlace_px(const CameraSettings& ccd, double distance_m) {
  const double beta = std::atan2(ccd.object_m * std::sin(ccd.alpha_rad), ccd.image_m * std::cos(ccd.alpha_rad));
  return ccd.centre_px + ccd.image_m * std::sin(ccd.alpha_rad) /
                             (ccd.object_m * std::sin(beta) / distance_m + std::sin(ccd.alpha_rad + beta)) /
                             ccd.pixel_m;
}

/// What one step of an input is: a um or an arcsec.
double StepOf(int input) {
  const int squareness = input - kMachineAxes * kBodyErrors;
  if (squareness >= 0 && squareness < kSquarenesses) return units::arcsec;
  const int error = squareness < 0 ? input % kBodyErrors : squareness - kSquarenesses;
  return IsRotation(error) ? units::arcsec : units::um;
}

/// d of / d unknown by central differences over a um and an arcsec: 3 rows a pose.
/// @param of  Of a pose and its inputs: three numbers.
template <class Of>
Eigen::MatrixXd SlopesBy(const Of& of, const std::vector<PoseRead>& poses, const Eigen::VectorXd& unknowns) {
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(3 * std::ssize(poses), unknowns.size());
  for (std::size_t p = 0; p < poses.size(); ++p) {
    const PoseRead& pose = poses[p];
    const Inputs at = InputsAt(pose, unknowns);
    const auto rows = Eigen::seqN(3 * static_cast<Eigen::Index>(p), 3);
    for (int k = 0; k < kInputs; ++k) {
      Inputs above = at, below = at;
      above[k] += StepOf(k);
      below[k] -= StepOf(k);
      const Vector3d slope = 0.5 * (of(pose, above) - of(pose, below));
      if (k >= kMachineAxes * kBodyErrors) {
        const int own = k - kMachineAxes * kBodyErrors;
        const int unknown = own < kSquarenesses ? SquarenessAt(own) : MountingAt(pose.setup, own - kSquarenesses);
        J(rows, unknown) = slope;
        continue;
      }
      double power = 1.0;
      for (int term = 0; term < kCubicTerms; ++term) {
        J(rows, k * kCubicTerms + term) = power * slope;
        power *= pose.t[static_cast<std::size_t>(k / kBodyErrors)];
      }
    }
  }
  return J;
}

}  // namespace

std::vector<PoseRead> PosesOf(const std::vector<Reading>& readings, const FreeformSettings& bench) {
  std::vector<PoseRead> poses;
  for (const Reading& r : readings) {
    const Vector3d shown(kQpdX_V(r), kQpdY_V(r), kCcd_px(r));
    if (r.status != ReadingStatus::kOk || !shown.allFinite()) continue;
    PoseRead& pose = poses.emplace_back();
    for (std::size_t axis = 0; axis < kMachineAxes; ++axis) {
      pose.at[axis] = kCommanded[axis](r);
      pose.t[axis] = (pose.at[axis] - bench.machine.centre[axis]) / bench.machine.half[axis];
    }
    pose.i = static_cast<int>(kCellI(r));
    pose.j = static_cast<int>(kCellJ(r));
    pose.setup = r.setup;
    pose.shown = shown;
  }
  return poses;
}

Inputs InputsAt(const PoseRead& pose, const Eigen::VectorXd& unknowns) {
  Inputs e;
  for (int k = 0; k < kMachineAxes * kBodyErrors; ++k) {
    const double t = pose.t[static_cast<std::size_t>(k / kBodyErrors)];
    const auto c = unknowns.segment<kCubicTerms>(k * kCubicTerms);
    e[k] = (c[0] + t * (c[1] + t * (c[2] + t * c[3]))) * StepOf(k);
  }
  e.segment<kSquarenesses>(kMachineAxes * kBodyErrors) =
      unknowns.segment<kSquarenesses>(SquarenessAt(0)) * units::arcsec;
  for (int k = 0; k < kBodyErrors; ++k) {
    const int input = kMachineAxes * kBodyErrors + kSquarenesses + k;
    e[input] = unknowns[MountingAt(pose.setup, k)] * StepOf(input);
  }
  return e;
}

Eigen::Vector3d Tip_m(const FreeformSettings& bench, const PoseRead& pose, const Inputs& inputs) {
  return OnSlide(bench, pose, inputs).point;
}

double SpotAt_m(double share, const QuadrantSettings& qpd) {
  constexpr double kMost = 0.999999;
  constexpr int kSteps = 40;  // of halving: a millionth of a millionth of the range
  double low = -3.0 * qpd.spot_radius_m, high = -low;
  for (int step = 0; step < kSteps; ++step) {
    const double middle = 0.5 * (low + high);
    const Eigen::Vector2d balance = Balance(middle, qpd);
    (balance[0] < std::clamp(share, -kMost, kMost) * balance[1] ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

Eigen::Vector3d Predicted(const FreeformSettings& bench, const PoseRead& pose, const Inputs& inputs) {
  const auto setup = static_cast<std::size_t>(pose.setup);
  const std::vector<MountSettings>& mounts = bench.freeform_procedure.mounts;
  const MountSettings mount = setup < mounts.size() ? mounts[setup] : MountSettings{};
  const std::array<double, kBodyErrors> nominal = {mount.x_m, mount.y_m, mount.z_m, 0.0, 0.0, mount.yaw_rad};
  Carried tool = OnSlide(bench, pose, inputs);
  tool.IntoChild(nominal.data());
  tool.IntoChild(inputs.data() + kMachineAxes * kBodyErrors + kSquarenesses);
  tool.point -= bench.artefact.pitch_m * Vector3d(pose.i, pose.j, 0.0);
  const double radius_m = bench.artefact.vertex_radius_m[(pose.i + pose.j) % 2 == 0 ? 0 : 1];
  const Vector3d beam = -tool.axes.col(2);
  const double distance_m = Distance_m(tool.point, beam, radius_m);
  const Vector3d hit = tool.point + distance_m * beam;
  const Vector3d up(-hit.x() / radius_m, -hit.y() / radius_m, 1.0);
  const Vector3d back = tool.axes.transpose() * (beam - 2.0 * beam.dot(up) / up.squaredNorm() * up);
  const Eigen::Vector2d x = Balance(bench.qpd.lens_m * back.x() / back.z(), bench.qpd);
  const Eigen::Vector2d y = Balance(bench.qpd.lens_m * back.y() / back.z(), bench.qpd);
  return {bench.qpd.sum_V * x[0] * y[1], bench.qpd.sum_V * y[0] * x[1], CameraPlace_px(bench.ccd, distance_m)};
}

Eigen::MatrixXd TipSlopes_um(const FreeformSettings& bench, const std::vector<PoseRead>& poses,
                             const Eigen::VectorXd& unknowns) {
  const auto tip_um = [&](const PoseRead& pose, const Inputs& inputs) -> Vector3d { return Tip_m(bench, pose, inputs) / units::um; };
  return SlopesBy(tip_um, poses, unknowns).leftCols(kOfMachine);
}

Eigen::MatrixXd Jacobian(const FreeformSettings& bench, const std::vector<PoseRead>& poses,
                         const Eigen::VectorXd& unknowns) {
  return SlopesBy([&](const PoseRead& pose, const Inputs& inputs) { return Predicted(bench, pose, inputs); }, poses, unknowns);
}

}  // namespace twinbench::benches::freeform::estimators
