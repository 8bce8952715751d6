#include "twin/benches/circular_motion/bench.h"
#include "twin/benches/circular_motion/columns.h"
#include "twin/benches/circular_motion/settings.h"
#include "twin/benches/circular_motion/twin/factory.h"
#include "twin/diagnose/products.h"

namespace twinbench::benches::circular {
namespace {

Eigen::VectorXd Shown_m(const Reading& r) {
  const Deviation deviation = DeviationOf(r);
  return Eigen::Vector2d(deviation.radial_m, deviation.tangential_m);
}

Eigen::VectorXd Noise_m(const Scenario& scenario, const Reading& r) {
  const StatedNoise noise = StatedNoiseOf(CircularOf(scenario), IsOfBar(r), Radius_m(r));
  return Eigen::Vector2d(noise.radial_m, noise.tangential_m);
}

/// Slopes of the twin at the spindle's place: what has a shape on a fine grid need not be asked point by point.
std::vector<diagnose::TwinComparison::Product> ProductsOf(const Scenario& scenario) {
  constexpr double kShortest_m = 2.0 * units::mm, kLongest_m = 40.0 * units::mm;  // of screws and scales
  std::vector<diagnose::TwinComparison::Product> products;
  for (const std::string axis : {"x", "y"}) {
    const Quantity& commanded_m = axis == "x" ? kCommandedX_m : kCommandedY_m;
    products.push_back(diagnose::WaveAlong("cyclic", axis, axis, "pitch", commanded_m, kShortest_m, kLongest_m));
    products.push_back(diagnose::SlipAt(axis, axis));
    products.push_back(
        diagnose::FollowsTemperature("drift", axis, axis, "drift", scenario.environment.reference_degC));
  }
  return products;
}

diagnose::TwinComparison Comparison(const Scenario& scenario) {
  diagnose::TwinComparison comparison;
  comparison.format = &Format();
  comparison.follow = FollowOften();
  comparison.unit = "um";
  comparison.to_SI = units::um;
  comparison.free_points = {"offset_x", "offset_y", "rotation", "length"};
  comparison.angles = {{"commanded", &Reading::target_rad}};
  comparison.plausible = 0.5 * units::um;
  comparison.shown = Shown_m;
  comparison.noise_of = Noise_m;
  comparison.products = ProductsOf(scenario);
  comparison.tones = {{"", Eigen::Vector2d(1.0, 0.0)}};
  return comparison;
}

}  // namespace

diagnose::DiagnosisRun Diagnose(const std::vector<Reading>& readings, const Scenario& scenario,
                                const diagnose::DiagnoseOptions& options) {
  return diagnose::DiagnoseByTwin(WithAngles(readings), scenario, options, Comparison(scenario));
}

diagnose::LinearRun Linear(const std::vector<Reading>& readings, const Scenario& scenario, Estimator) {
  return diagnose::CompareWithTwin(WithAngles(readings), scenario, Comparison(scenario));
}

}  // namespace twinbench::benches::circular
