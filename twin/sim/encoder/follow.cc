#include "twin/sim/encoder/follow.h"

#include <cmath>

#include "twin/core/errors.h"
#include "twin/sim/encoder/twin.h"

namespace twinbench::sim {
namespace {

/// Without chance, and without single outliers, which nobody can foresee.
Scenario Foreseeable(Scenario scenario) {
  scenario.noise_free = true;
  std::erase_if(scenario.effects, [](const EffectSettings& e) { return e.name == "outliers"; });
  return scenario;
}

class EncoderFollow : public model::Follow {
 public:
  EncoderFollow(const Scenario& scenario, const std::vector<Reading>& record)
      : scenario_(Foreseeable(scenario)), record_(record) {
    for (Reading& r : record_) {
      if (!std::isfinite(r.velocity_rad_s)) r.velocity_rad_s = 0.0;
    }
  }

  const std::vector<model::Point>& Points() const override { return points_; }

  Eigen::MatrixXd Predict(const std::vector<model::Disturbance>& disturbances) const override {
    Eigen::VectorXd shaft_rad = Eigen::VectorXd::Zero(std::ssize(record_)), device_rad = shaft_rad;
    for (const model::Disturbance& d : disturbances) {
      Require(d.point == "shaft" || d.point == "device", "the angle comparison has no point of that name");
      Require(d.value.size() == shaft_rad.size(), "a disturbance has one value a reading");
      (d.point == "shaft" ? shaft_rad : device_rad) += d.value;
    }
    EncoderTwin twin(scenario_);  // anew: its effects have memories
    for (Eigen::Index i = 0; i < shaft_rad.size(); ++i)
      device_rad[i] += twin.DeviceAt_rad(record_[static_cast<std::size_t>(i)], shaft_rad[i]);
    return device_rad;
  }

  std::vector<std::string> Unfixed() const override {
    return {"angles of the device on the shaft: free in every set-up"};
  }

 private:
  Scenario scenario_;
  std::vector<Reading> record_;
  std::vector<model::Point> points_ = {{"shaft", "deg", units::deg, 1.0 * units::arcsec},
                                       {"device", "deg", units::deg, 1.0 * units::arcsec}};
};

}  // namespace

std::unique_ptr<model::Follow> FollowEncoder(const Scenario& scenario, const std::vector<Reading>& record) {
  return std::make_unique<EncoderFollow>(scenario, record);
}

}  // namespace twinbench::sim
