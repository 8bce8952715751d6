#include "twin/benches/freeform_five_axis/procedure.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "twin/benches/freeform_five_axis/columns.h"
#include "twin/core/stream.h"
#include "twin/core/time.h"

namespace twinbench::procedure {
namespace {

using Eigen::Vector3d;

struct Drawn {
  int i = 0, j = 0;
  double a_rad = 0.0, b_rad = 0.0, height_m = 0.0;
};

struct FreeformPose {
  Drawn drawn;
  std::array<double, 5> commanded{};  // X, Y, Z [m], A, B [rad]
};

/// Whole millionths of the unit of the file.
double Rounded(double value_SI, double to_SI) {
  constexpr double kPerUnit = 1e6;
  return std::round(value_SI / to_SI * kPerUnit) / kPerUnit * to_SI;
}

class PoseDrawing {
 public:
  explicit PoseDrawing(const Scenario& scenario)
      : own_(FreeformOf(scenario)), random_(scenario.seed, "procedure.poses") {}

  FreeformPose Next(const MountSettings& mount, int pose) {
    FreeformPose next;
    next.drawn = Draw(pose);
    next.commanded = NormalTo(next.drawn, mount);
    const FreeformProcedureSettings& p = own_.freeform_procedure;
    const std::array<double, 5> dither = {p.dither_m, p.dither_m, 0.0, p.dither_rad, p.dither_rad};
    for (std::size_t axis = 0; axis < 5; ++axis)
      next.commanded[axis] =
          Rounded(next.commanded[axis] + Within(dither[axis]), axis < 3 ? units::mm : units::deg);
    return next;
  }

 private:
  double Within(double half) { return half * (2.0 * random_.Uniform() - 1.0); }
  int Cell() {
    const int side = 2 * own_.artefact.cells + 1;
    return static_cast<int>(random_.Uniform() * side) - own_.artefact.cells;
  }

  Drawn Draw(int pose) {
    const FreeformProcedureSettings& p = own_.freeform_procedure;
    const int cell_i = Cell(), cell_j = Cell();
    Drawn drawn{cell_i, cell_j, Within(p.angle_rad), Within(p.angle_rad), Within(p.height_m)};
    if (p.path != "single") return drawn;
    const int moved = std::min(3, 4 * pose / p.poses);
    if (moved != 0) drawn.i = 0;
    if (moved != 1) drawn.j = 0;
    if (moved != 2) drawn.a_rad = 0.0;
    if (moved != 3) drawn.b_rad = 0.0;
    return drawn;
  }

  /// X, Y and Z of the ideal machine that put the tip on the normal of the cell that has the beam's direction.
  std::array<double, 5> NormalTo(const Drawn& d, const MountSettings& mount) const {
    const Eigen::AngleAxisd yaw(mount.yaw_rad, Vector3d::UnitZ());
    const Vector3d beam = Eigen::AngleAxisd(d.a_rad, Vector3d::UnitX()) *
                          (Eigen::AngleAxisd(d.b_rad, Vector3d::UnitY()) * Vector3d::UnitZ());
    const Vector3d normal = yaw.inverse() * beam;
    const double radius_m = own_.artefact.vertex_radius_m[(d.i + d.j) % 2 == 0 ? 0 : 1];
    Vector3d hit = -radius_m / normal.z() * normal;
    hit.z() = (hit.x() * hit.x() + hit.y() * hit.y()) / (2.0 * radius_m);
    const Vector3d vertex(d.i * own_.artefact.pitch_m, d.j * own_.artefact.pitch_m, 0.0);
    const Vector3d tip = yaw * (vertex + hit + d.height_m * normal) + Vector3d(mount.x_m, mount.y_m, mount.z_m);
    const Vector3d tip_of_tool = own_.machine.pivot_m * (Vector3d::UnitZ() - beam);
    const Vector3d slides = tip - tip_of_tool;
    return {-slides.x(), slides.y(), slides.z(), d.a_rad, d.b_rad};
  }

  const FreeformSettings& own_;
  Stream random_;
};

}  // namespace

std::vector<Reading> FreeformSchedule(const Scenario& scenario) {
  const FreeformProcedureSettings& p = FreeformOf(scenario).freeform_procedure;
  using benches::freeform::kCellI, benches::freeform::kCellJ, benches::freeform::kCommanded;
  PoseDrawing drawing(scenario);
  std::vector<Reading> readings;
  double time_s = 0.0;
  for (std::size_t setup = 0; setup < p.mounts.size(); ++setup) {
    std::vector<FreeformPose> poses;
    for (int k = 0; k < p.poses; ++k) poses.push_back(drawing.Next(p.mounts[setup], k));
    for (const int pass : {0, 1}) {
      for (int k = 0; k < p.poses; ++k) {
        Reading& r = readings.emplace_back();
        r.reading = static_cast<int>(readings.size()) - 1;
        r.time = Time(FromSeconds(time_s));
        r.setup = static_cast<int>(setup);
        r.pass = pass;
        r.direction = pass == 0 ? 1 : -1;
        r.position = pass == 0 ? k : p.poses - 1 - k;
        const FreeformPose& pose = poses[static_cast<std::size_t>(r.position)];
        for (std::size_t axis = 0; axis < 5; ++axis) kCommanded[axis](r) = pose.commanded[axis];
        kCellI(r) = pose.drawn.i;
        kCellJ(r) = pose.drawn.j;
        time_s += p.interval_s;
      }
    }
    time_s += p.remount_s;
  }
  return readings;
}

}  // namespace twinbench::procedure
