#include <cmath>

#include "twin/benches/circular_motion/bench.h"
#include "twin/benches/circular_motion/columns.h"
#include "twin/benches/circular_motion/settings.h"
#include "twin/benches/circular_motion/twin/factory.h"
#include "twin/diagnose/by_twin.h"

namespace twinbench::benches::circular {
namespace {

Eigen::VectorXd Shown_m(const Reading& r) {
  const Deviation deviation = DeviationOf(r);
  return Eigen::Vector2d(deviation.radial_m, deviation.tangential_m);
}

/// Of radius and angle as the instrument reads them, with the machine's own repeatability.
Eigen::VectorXd Noise_m(const Scenario& scenario, const Reading& r) {
  const CircularSettings& s = CircularOf(scenario);
  const auto with_machine = [&](double noise_m) { return std::hypot(noise_m, s.machine.noise_m); };
  if (!IsOfBar(r)) return Eigen::VectorXd::Constant(2, with_machine(s.grid.noise_m));
  const double quantum = 1.0 / std::sqrt(12.0);
  const double step_rad = units::turn / s.encoder.lines / s.encoder.interpolation;
  return Eigen::Vector2d(with_machine(std::hypot(s.bar.noise_m, quantum * s.bar.resolution_m)),
                         with_machine(Radius_m(r) * std::hypot(s.encoder.noise_rad, quantum * step_rad)));
}

diagnose::TwinComparison Comparison() {
  diagnose::TwinComparison comparison;
  comparison.format = &Format();
  comparison.follow = FollowRecord;
  comparison.unit = "um";
  comparison.to_SI = units::um;
  comparison.free_points = {"offset_x", "offset_y", "rotation", "length"};
  comparison.angles = {{"commanded", &Reading::target_rad}};
  comparison.plausible = 0.5 * units::um;
  comparison.shown = Shown_m;
  comparison.noise_of = Noise_m;
  return comparison;
}

}  // namespace

diagnose::DiagnosisRun Diagnose(const std::vector<Reading>& readings, const Scenario& scenario,
                                const diagnose::DiagnoseOptions& options) {
  return diagnose::DiagnoseByTwin(WithAngles(readings), scenario, options, Comparison());
}

diagnose::LinearRun Linear(const std::vector<Reading>& readings, const Scenario& scenario, Estimator) {
  return diagnose::CompareWithTwin(WithAngles(readings), scenario, Comparison());
}

}  // namespace twinbench::benches::circular
