#include "twin/benches/freeform_five_axis/place_noise.h"

#include <algorithm>
#include <cmath>

#include "twin/benches/freeform_five_axis/columns.h"
#include "twin/benches/freeform_five_axis/estimators/probe_model.h"
#include "twin/benches/freeform_five_axis/procedure.h"

namespace twinbench::benches::freeform {
namespace {

constexpr double kReadingsAPose = 2.0;   // forth and back
constexpr std::size_t kMostPoses = 200;  // are enough for a mean

/// The reading at a pose with one axis moved off it.
Eigen::Vector3d Off(const FreeformSettings& bench, estimators::PoseRead pose, std::size_t axis, double by) {
  pose.at[axis] += by;
  return estimators::Predicted(bench, pose, estimators::Inputs::Zero());
}

double Information(const FreeformSettings& bench, const estimators::PoseRead& pose, std::size_t axis) {
  const double step = IsRotaryAxis(static_cast<int>(axis)) ? units::arcsec : units::um;
  const Eigen::Vector3d slope = (Off(bench, pose, axis, step) - Off(bench, pose, axis, -step)) / (2.0 * step);
  const Eigen::Vector3d noise(bench.qpd.noise_V, bench.qpd.noise_V, bench.ccd.noise_px);
  return slope.cwiseQuotient(noise).squaredNorm();
}

}  // namespace

std::array<double, kMachineAxes> PlaceNoise(const Scenario& scenario) {
  const FreeformSettings& bench = FreeformOf(scenario);
  std::vector<Reading> plan = procedure::FreeformSchedule(scenario);
  plan.resize(std::min(plan.size(), kMostPoses));
  for (Reading& planned : plan) kQpdX_V(planned) = kQpdY_V(planned) = kCcd_px(planned) = 0.0;  // else it is no pose
  std::array<double, kMachineAxes> u{};
  const std::vector<estimators::PoseRead> poses = estimators::PosesOf(plan, bench);
  for (std::size_t axis = 0; axis < u.size(); ++axis) {
    double sum = 0.0;
    for (const estimators::PoseRead& pose : poses) sum += Information(bench, pose, axis);
    u[axis] = 1.0 / std::sqrt(kReadingsAPose * sum / static_cast<double>(poses.size()));
  }
  return u;
}

}  // namespace twinbench::benches::freeform
