#include <algorithm>
#include <cmath>
#include <memory>

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

bool HasAngles(const std::vector<Reading>& readings) {
  return std::ranges::any_of(readings, [](const Reading& r) { return std::isfinite(DeviationOf(r).tangential_m); });
}

/// The bench where its readings show the radius alone.
const BenchFormat& OfRadii() {
  static const BenchFormat format = [] {
    BenchFormat f = Format();
    f.channels = f.points = {f.channels.front()};
    return f;
  }();
  return format;
}

/// The twin's radius alone.
class FollowRadii : public model::Follow {
 public:
  explicit FollowRadii(std::unique_ptr<model::Follow> whole) : whole_(std::move(whole)) {}
  const std::vector<model::Point>& Points() const override { return whole_->Points(); }
  Eigen::Index Readings() const override { return whole_->Readings(); }
  Eigen::MatrixXd Predict(const std::vector<model::Disturbance>& at) const override { return whole_->Predict(at).leftCols(1); }
  std::vector<std::string> Unfixed() const override { return whole_->Unfixed(); }

 private:
  std::unique_ptr<model::Follow> whole_;
};

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

/// Of the radius alone: what turns the circle is not free, for it is not seen.
diagnose::TwinComparison OfRadiiAlone(diagnose::TwinComparison comparison) {
  comparison.format = &OfRadii();
  comparison.follow = [whole = comparison.follow](const Scenario& scenario, const std::vector<Reading>& record) {
    return std::make_unique<FollowRadii>(whole(scenario, record));
  };
  comparison.free_points = {"offset_x", "offset_y", "length"};
  comparison.shown = [](const Reading& r) { return Eigen::VectorXd(Shown_m(r).head(1)); };
  comparison.noise_of = [](const Scenario& scenario, const Reading& r) { return Eigen::VectorXd(Noise_m(scenario, r).head(1)); };
  comparison.tones = {{"", Eigen::VectorXd::Ones(1)}};
  return comparison;
}

diagnose::TwinComparison Comparison(const Scenario& scenario, const std::vector<Reading>& readings) {
  return HasAngles(readings) ? Comparison(scenario) : OfRadiiAlone(Comparison(scenario));
}

}  // namespace

diagnose::DiagnosisRun Diagnose(const std::vector<Reading>& readings, const Scenario& scenario,
                                const diagnose::DiagnoseOptions& options) {
  return diagnose::DiagnoseByTwin(WithAngles(readings), scenario, options, Comparison(scenario, readings));
}

diagnose::LinearRun Linear(const std::vector<Reading>& readings, const Scenario& scenario, Estimator) {
  return diagnose::CompareWithTwin(WithAngles(readings), scenario, Comparison(scenario, readings));
}

}  // namespace twinbench::benches::circular
