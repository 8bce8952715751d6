#include "twin/benches/freeform_five_axis/tables.h"

#include <fmt/format.h>

#include <algorithm>

namespace twinbench::benches::freeform {
namespace {

using namespace estimators;

double UnitOfAxis(std::size_t axis) {
  return IsRotaryAxis(static_cast<int>(axis)) ? units::deg : units::mm;
}

std::string Xyz(const Eigen::Vector3d& v) {
  return fmt::format("{:.4f},{:.4f},{:.4f}", v.x(), v.y(), v.z());
}

/// The six errors of one axis with the coordinate at `at`, um and arcsec.
std::string ErrorsAtNode(const MachineSettings& machine, const Identification& found, std::size_t axis, double at) {
  PoseRead pose;
  pose.t[axis] = (at - machine.centre[axis]) / machine.half[axis];
  const Inputs inputs = InputsAt(pose, found.unknowns);
  std::string row = fmt::format("{},{:.6f}", kAxisNames[axis], at / UnitOfAxis(axis));
  for (int error = 0; error < kBodyErrors; ++error) {
    const double unit = IsRotation(error) ? units::arcsec : units::um;
    row += fmt::format(",{:.4f}", inputs[static_cast<Eigen::Index>(axis) * kBodyErrors + error] / unit);
  }
  return row + "\n";
}

}  // namespace

std::string VolumetricCsv(const std::vector<PoseRead>& poses, const VolumetricErrors& errors) {
  std::string csv = "x_mm,y_mm,z_mm,a_deg,b_deg,dx_um,dy_um,dz_um,u_dx_um,u_dy_um,u_dz_um\n";
  for (std::size_t p = 0; p < poses.size(); ++p) {
    for (std::size_t axis = 0; axis < kMachineAxes; ++axis)
      csv += fmt::format("{:.6f},", poses[p].at[axis] / UnitOfAxis(axis));
    const auto column = static_cast<Eigen::Index>(p);
    csv += Xyz(errors.error_um.col(column)) + "," + Xyz(errors.u_um.col(column)) + "\n";
  }
  return csv;
}

std::string CompensationCsv(const FreeformSettings& bench, const std::vector<PoseRead>& seen,
                            const Identification& found) {
  constexpr int kNodes = 21;
  std::string csv = "axis,coordinate_mm_or_deg,tx_um,ty_um,tz_um,rx_arcsec,ry_arcsec,rz_arcsec\n";
  for (std::size_t axis = 0; axis < kMachineAxes; ++axis) {
    const auto [low, high] = std::ranges::minmax(seen, {}, [axis](const PoseRead& p) { return p.at[axis]; });
    for (int node = 0; node < kNodes; ++node)
      csv += ErrorsAtNode(bench.machine, found, axis,
                          low.at[axis] + (high.at[axis] - low.at[axis]) * node / (kNodes - 1));
  }
  csv += "squareness,arcsec\n";
  for (int k = 0; k < kSquarenesses; ++k)
    csv +=
        fmt::format("{},{:.4f}\n", kSquarenessNames[static_cast<std::size_t>(k)], found.unknowns[SquarenessAt(k)]);
  return csv;
}

}  // namespace twinbench::benches::freeform
