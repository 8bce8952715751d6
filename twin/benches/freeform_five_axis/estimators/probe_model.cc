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
};

/// Into the frame of the next body: shifted, turned, shifted.
struct Stage {
  Matrix3d R;
  Vector3d before, after;
  bool turns;

  void Carry(Carried& tool) const {
    tool.point += before;
    if (turns) {
      tool.point = R * tool.point;
      tool.axes = R * tool.axes;
    }
    tool.point += after;
  }
};

Stage IntoParent(const double* error) {  // of a body: tx, ty, tz, rx, ry, rz
  return {Turn(error[3], error[4], error[5]), Vector3d::Zero(), Vector3d(error[0], error[1], error[2]), true};
}

Stage IntoChild(const double* error) {
  return {Turn(error[3], error[4], error[5]).transpose(), -Vector3d(error[0], error[1], error[2]), Vector3d::Zero(), true};
}

Stage Along(const Vector3d& before, const Vector3d& after) {
  return {Matrix3d::Identity(), before, after, false};
}

constexpr int kOfSquareness = kMachineAxes * kBodyErrors, kOfMounting = kOfSquareness + kSquarenesses;
constexpr int kToSlide = 9, kToArtefact = 11;  // stages

Stage StageOf(int stage, const FreeformSettings& bench, const PoseRead& pose, const Inputs& e) {
  const double* const body = e.data();
  const double* const s = body + kOfSquareness;  // syx szx szy say saz sbx sbz
  switch (stage) {
    case 0: return IntoParent(body + 24);
    case 1: {
      const Matrix3d S_b = Turn(0.0, 0.0, s[6]) * Turn(s[5], 0.0, 0.0);
      return {S_b * Turn(0.0, pose.at[4], 0.0) * S_b.transpose(), Vector3d::Zero(), Vector3d::Zero(), true};
    }
    case 2: return IntoParent(body + 18);
    case 3: {
      const Matrix3d S_a = Turn(0.0, s[3], 0.0), Z_a = Turn(0.0, 0.0, s[4]);
      return {Z_a * S_a * Turn(pose.at[3], 0.0, 0.0) * S_a.transpose() * Z_a.transpose(), Vector3d::Zero(),
              Vector3d(0.0, 0.0, bench.machine.pivot_m), true};
    }
    case 4: return IntoParent(body + 12);
    case 5:  // Ry(szx) Rx(szy) z and, below, Rz(syx) y, multiplied out
      return Along(pose.at[2] * Vector3d(std::sin(s[1]) * std::cos(s[2]), -std::sin(s[2]), std::cos(s[1]) * std::cos(s[2])),
                   Vector3d::Zero());
    case 6: return IntoParent(body + 6);
    case 7: return Along(pose.at[1] * Vector3d(-std::sin(s[0]), std::cos(s[0]), 0.0), Vector3d(-pose.at[0], 0.0, 0.0));
    case 8: return IntoChild(body);
    case 9: {
      const auto setup = static_cast<std::size_t>(pose.setup);
      const std::vector<MountSettings>& mounts = bench.freeform_procedure.mounts;
      const MountSettings mount = setup < mounts.size() ? mounts[setup] : MountSettings{};
      const std::array<double, kBodyErrors> nominal = {mount.x_m, mount.y_m, mount.z_m, 0.0, 0.0, mount.yaw_rad};
      return IntoChild(nominal.data());
    }
    default: return IntoChild(body + kOfMounting);
  }
}

/// The one stage that an input acts in.
int StageWith(int input) {
  constexpr std::array<int, kMachineAxes> kOfAxis = {8, 6, 4, 2, 0};
  constexpr std::array<int, kSquarenesses> kOfSquareAxes = {7, 5, 5, 3, 3, 1, 1};
  if (input < kOfSquareness) return kOfAxis[static_cast<std::size_t>(input / kBodyErrors)];
  return input < kOfMounting ? kOfSquareAxes[static_cast<std::size_t>(input - kOfSquareness)] : kToArtefact - 1;
}

/// The tool's way through the bodies: into the X slide's frame, and on into that of the artefact. An input that is changed leaves the
/// stages before its own where they are and those behind it as they turn and shift.
class Way {
 public:
  Way(const FreeformSettings& bench, const PoseRead& pose, const Inputs& inputs, int stages)
      : bench_(bench), pose_(pose), stages_(static_cast<std::size_t>(stages)) {
    Carried tool{Vector3d(0.0, 0.0, -bench.machine.pivot_m)};
    for (std::size_t k = 0; k < stages_; ++k) {
      into_[k] = tool;
      stage_[k] = StageOf(static_cast<int>(k), bench, pose, inputs);
      stage_[k].Carry(tool);
    }
    end_ = tool;
  }
  const Carried& End() const { return end_; }
  Carried EndWith(int input, const Inputs& changed) const {
    const auto first = static_cast<std::size_t>(StageWith(input));
    if (first >= stages_) return end_;
    Carried tool = into_[first];
    StageOf(static_cast<int>(first), bench_, pose_, changed).Carry(tool);
    for (std::size_t k = first + 1; k < stages_; ++k) stage_[k].Carry(tool);
    return tool;
  }

 private:
  const FreeformSettings& bench_;
  const PoseRead& pose_;
  std::size_t stages_;
  std::array<Stage, kToArtefact> stage_;
  std::array<Carried, kToArtefact> into_;
  Carried end_;
};

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

/// What the probe reads where the tool stands like this before the artefact.
Vector3d SeenBy(const FreeformSettings& bench, const PoseRead& pose, Carried tool) {
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

/// What one step of an input is: a um or an arcsec.
double StepOf(int input) {
  const int squareness = input - kMachineAxes * kBodyErrors;
  if (squareness >= 0 && squareness < kSquarenesses) return units::arcsec;
  const int error = squareness < 0 ? input % kBodyErrors : squareness - kSquarenesses;
  return IsRotation(error) ? units::arcsec : units::um;
}

/// d of / d unknown by central differences over a um and an arcsec: 3 rows a pose.
/// @param of  Of a pose and the tool behind so many stages of its way: three numbers.
template <class Of>
Eigen::MatrixXd SlopesBy(const Of& of, int stages, const FreeformSettings& bench, const std::vector<PoseRead>& poses,
                         const Eigen::VectorXd& unknowns) {
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(3 * std::ssize(poses), unknowns.size());
  for (std::size_t p = 0; p < poses.size(); ++p) {
    const PoseRead& pose = poses[p];
    const Inputs at = InputsAt(pose, unknowns);
    const Way way(bench, pose, at, stages);
    const auto rows = Eigen::seqN(3 * static_cast<Eigen::Index>(p), 3);
    for (int k = 0; k < kInputs; ++k) {
      Inputs above = at, below = at;
      above[k] += StepOf(k);
      below[k] -= StepOf(k);
      const Vector3d slope = 0.5 * (of(pose, way.EndWith(k, above)) - of(pose, way.EndWith(k, below)));
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
    pose.reading = r.reading;
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
  return Way(bench, pose, inputs, kToSlide).End().point;
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
  return SeenBy(bench, pose, Way(bench, pose, inputs, kToArtefact).End());
}

Eigen::MatrixXd TipSlopes_um(const FreeformSettings& bench, const std::vector<PoseRead>& poses,
                             const Eigen::VectorXd& unknowns) {
  const auto tip_um = [](const PoseRead& /*pose*/, const Carried& tool) -> Vector3d { return tool.point / units::um; };
  return SlopesBy(tip_um, kToSlide, bench, poses, unknowns).leftCols(kOfMachine);
}

Eigen::MatrixXd Jacobian(const FreeformSettings& bench, const std::vector<PoseRead>& poses,
                         const Eigen::VectorXd& unknowns) {
  const auto seen = [&](const PoseRead& pose, const Carried& tool) { return SeenBy(bench, pose, tool); };
  return SlopesBy(seen, kToArtefact, bench, poses, unknowns);
}

}  // namespace twinbench::benches::freeform::estimators
