#include "twin/sim/rotary_follow.h"

#include <algorithm>
#include <cmath>

#include "twin/core/errors.h"
#include "twin/sim/rotary_course.h"
#include "twin/sim/rotary_points.h"

namespace twinbench::sim {
namespace {

/// Without what a run leaves free, without chance, and without single outliers, which nobody can foresee.
Scenario Foreseeable(Scenario scenario) {
  scenario.noise_free = true;
  for (TableSettings* table : {&scenario.target, &scenario.reference}) {
    table->harmonics.clear();
    table->errors.reset();
    table->random_rms = {};
  }
  std::erase_if(scenario.effects, [](const EffectSettings& e) { return e.name == "outliers"; });
  return scenario;
}

PoseState Sum(PoseState a, const PoseState& b) {
  a.target_yaw_rad += b.target_yaw_rad;
  a.reference_yaw_rad += b.reference_yaw_rad;
  a.grating_yaw_rad += b.grating_yaw_rad;
  a.grating_tilt_rad += b.grating_tilt_rad;
  a.grating_roll_rad += b.grating_roll_rad;
  a.grating_shift_m += b.grating_shift_m;
  a.target_error = a.target_error + b.target_error;
  a.reference_error = a.reference_error + b.reference_error;
  return a;
}

class RotaryFollow : public model::Follow {
 public:
  RotaryFollow(const Scenario& scenario, const std::vector<Reading>& record)
      : scenario_(Foreseeable(scenario)),
        stated_noise_V_(scenario.noise_free ? 0.0 : scenario.amplifier.noise_V),
        record_(record),
        path_(scenario_),
        course_(FollowCourse(record, scenario.noise_free ? 0.0 : scenario.environment.sensor_noise_K, path_)) {
    for (const RotaryPoint& p : RotaryPoints()) points_.push_back(p.point);
  }

  const std::vector<model::Point>& Points() const override { return points_; }
  std::vector<std::string> Unfixed() const override { return course_.unfixed; }

  Eigen::MatrixXd Predict(const std::vector<model::Disturbance>& disturbances) const override {
    std::vector<RotaryExtra> extra(record_.size());
    std::vector<model::Disturbance> of_bench;
    for (const model::Disturbance& d : disturbances) {
      Require(d.value.size() == std::ssize(record_), "a disturbance has one value a reading");
      const RotaryPoint& point = PointOf(d.point);
      if (!point.of_reading) {
        of_bench.push_back(d);
        continue;
      }
      for (std::size_t i = 0; i < extra.size(); ++i) point.of_reading(extra[i]) += d.value[static_cast<Eigen::Index>(i)];
    }
    Eigen::MatrixXd shown_V(std::ssize(record_), kChannels);
    for (std::size_t i = 0; i < extra.size(); ++i) {
      const std::array<double, kChannels> reading_V = Shown_V(i, extra[i]);
      for (int c = 0; c < kChannels; ++c) shown_V(static_cast<Eigen::Index>(i), c) = reading_V[c];
    }
    for (const model::Disturbance& d : of_bench) shown_V += OfBench_V(d);
    return shown_V;
  }

 private:
  static const RotaryPoint& PointOf(const std::string& name) {
    const auto found = std::ranges::find(RotaryPoints(), name, [](const RotaryPoint& p) { return p.point.name; });
    Require(found != RotaryPoints().end(), "the rotary bench has no point of that name");
    return *found;
  }

  /// A constant of the bench, changed from reading to reading: to first order.
  Eigen::MatrixXd OfBench_V(const model::Disturbance& d) const {
    return d.value.asDiagonal() * BenchSlope_V(PointOf(d.point));
  }

  Eigen::MatrixXd BenchSlope_V(const RotaryPoint& point) const {
    const auto shown = [&](double step) {
      Scenario changed = scenario_;
      point.of_bench(changed) += step;
      changed.amplifier.noise_V = stated_noise_V_;
      // The PSDs stay where the nominal light would meet them.
      return RotaryFollow(changed, record_).Predict({});
    };
    return (shown(point.point.step) - shown(-point.point.step)) / (2.0 * point.point.step);
  }

  /// X_LG, with the grating on its goniometer where the autocollimator saw it.
  Pose GratingPose(std::size_t i, const RotaryExtra& extra) const {
    const RecordedStop& stop = course_.stops[i];
    const Stand& stand = course_.stands[static_cast<std::size_t>(stop.mounting)];
    PoseState pose = Sum(stop.pose, extra.pose);
    const auto at = [&] { return sim::GratingPose(stand, path_.effects(), stop.moment, stop.axes, pose); };
    if (!stop.swept) return at() * mechanics::ToPose(extra.mount);
    constexpr int kIterations = 3;  // each squares what is left of some milliradians
    for (int k = 0; k < kIterations; ++k) {
      const Vector3 normal_L = at().linear().col(1);
      pose.grating_yaw_rad += stop.seen_yaw_rad - std::atan2(-normal_L.x(), normal_L.y());
      pose.grating_tilt_rad += stop.seen_tilt_rad - std::atan2(normal_L.z(), std::hypot(normal_L.x(), normal_L.y()));
    }
    return at() * mechanics::ToPose(extra.mount);
  }

  std::array<double, kChannels> Shown_V(std::size_t i, const RotaryExtra& extra) const {
    const RecordedStop& stop = course_.stops[i];
    LightState light = stop.light;
    light.wavelength_m += extra.light.wavelength_m;
    light.yaw_rad += extra.light.yaw_rad;
    light.pitch_rad += extra.light.pitch_rad;
    const Spots spots = path_.light().Trace(GratingPose(i, extra), light);
    std::array<double, kChannels> spots_m = spots.uv_m;
    if (spots.status != ReadingStatus::kOk) return {kNaN, kNaN, kNaN, kNaN};
    std::array<double, kChannels> signal_V = path_.electronics().Amplify(spots_m);
    for (int c = 0; c < kChannels; ++c) {
      const double sensitivity_V_m = (c < 2 ? scenario_.psd_a : scenario_.psd_b).sensitivity_V_m;
      signal_V[c] += stop.added_V[c] + sensitivity_V_m * extra.shown_m[c];
    }
    return ReadOut(path_.electronics().Expect(signal_V, stop.moment.now, stop.n_samples, stated_noise_V_));
  }

  std::array<double, kChannels> ReadOut(const std::array<double, kChannels>& mean_V) const {
    Acquisition block;
    for (int c = 0; c < kChannels; ++c) block.channel[c].mean_V = mean_V[c];
    path_.effects().AlterReadout(block);
    return {block.channel[0].mean_V, block.channel[1].mean_V, block.channel[2].mean_V, block.channel[3].mean_V};
  }

  Scenario scenario_;
  double stated_noise_V_;
  std::vector<Reading> record_;
  OpticalPath path_;
  RotaryCourse course_;
  std::vector<model::Point> points_;
};

}  // namespace

std::unique_ptr<model::Follow> FollowRotary(const Scenario& scenario, const std::vector<Reading>& record) {
  try {
    return std::make_unique<RotaryFollow>(scenario, record);
  } catch (const std::invalid_argument& error) {
    throw InputError("bench " + scenario.bench, error.what(), "a scenario of parts that can be built");
  }
}

}  // namespace twinbench::sim
