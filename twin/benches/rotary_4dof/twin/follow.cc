#include "twin/benches/rotary_4dof/twin/twin.h"

#include <algorithm>
#include <cmath>

#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/course.h"
#include "twin/benches/rotary_4dof/twin/points.h"
#include "twin/benches/rotary_4dof/twin/table_stack.h"
#include "twin/core/built.h"

namespace twinbench::sim {
namespace {

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

double IfNoisy(const Scenario& stated, double noise) {
  return stated.noise_free ? 0.0 : noise;
}

/// Shortest time from the end of a move to a reading [s]; tables that are mounted have long stood.
double ShortestWait_s(const RotarySettings& own, const std::vector<Reading>& record) {
  double wait_s = own.procedure.remount_s;
  for (const Reading& r : record) {
    if (r.phase == Phase::kFullCircle) wait_s = std::min(wait_s, std::isfinite(r.dwell_s) ? r.dwell_s : 0.0);
  }
  return wait_s + std::min(own.target.settle_s, own.reference.settle_s);
}

/// Rate [1/s] at which what a move leaves decays at least: of the controllers' slowest pole, 0.43 of their
/// bandwidth (ServoGains), or of the bearings' lowest mode, which has half of the stated damping or more.
double SlowestDecay_1_s(const Scenario& scenario) {
  const MechanicsSettings& m = RotaryOf(scenario).mechanics;
  mechanics::StackDynamics dynamics(StackOf(RotaryTableStack(scenario)));
  const double servo_1_s = 0.43 * 2.0 * units::kPi * std::min(m.servo_Hz[0], m.servo_Hz[1]);
  return std::min(servo_1_s, 0.5 * m.damping_ratio * mechanics::LowestFrequency(dynamics));
}

/// Whether where the tables stand at a reading depends on nothing but where they were sent: what a move leaves,
/// some arcsec and a micrometre at most, has fallen below 1e-12 rad and m, e^-16 of it.
bool StandsStill(const Scenario& scenario, const std::vector<Reading>& record) {
  const RotarySettings& own = RotaryOf(scenario);
  const MechanicsSettings& m = own.mechanics;
  if (own.target.backlash_rad > 0.0 || own.reference.backlash_rad > 0.0) return false;
  for (std::size_t i = 0; i < 2; ++i) {
    const bool rubs = m.friction_Nm[i] > 0.0 || m.friction_viscous_Nm_s[i] > 0.0;
    if (rubs || m.encoder_resolution_rad[i] > 0.0) return false;
  }
  return SlowestDecay_1_s(scenario) * ShortestWait_s(own, record) > 16.0;
}

/// What readings are compared with: the linear model in place of Bullet, and no dynamics where they are long over.
void ChooseMotion(Scenario& scenario, const std::vector<Reading>& record) {
  MechanicsSettings& mechanics = RotaryOf(scenario).mechanics;
  if (mechanics.fidelity != "bullet") return;
  WithoutBullet(mechanics);
  if (StandsStill(scenario, record)) mechanics.fidelity = "kinematic";
}

Scenario WithFreeTables(Scenario scenario, const std::vector<Reading>& record) {
  RotarySettings& own = RotaryOf(scenario);
  LeaveFree(own.target);
  LeaveFree(own.reference);
  ChooseMotion(scenario, record);
  return scenario;
}

class RotaryFollow : public PointwiseFollow<RotaryExtra> {
 public:
  RotaryFollow(const Scenario& stated, const std::vector<Reading>& record, std::shared_ptr<DrivesOnce> drives)
      : PointwiseFollow(WithFreeTables(Foreseeable(stated, AtMiddleOfBlocks(record, RotaryOf(stated).adc)), record),
                        record, RotaryPoints()),
        noise_V_(IfNoisy(stated, RotaryOf(stated).amplifier.noise_V)),
        thermometer_noise_K_(IfNoisy(stated, stated.environment.sensor_noise_K)),
        path_(scenario(), LightAsked::kQuickly),
        drives_(std::move(drives)),
        course_(FollowCourse(record, thermometer_noise_K_, path_, *drives_)) {}

  std::vector<std::string> Unfixed() const override { return course_.unfixed; }

 protected:
  Eigen::MatrixXd Shown(const std::vector<RotaryExtra>& extra) const override {
    const std::vector<Spots> spots = SpotsOf(extra);
    Eigen::MatrixXd shown_V(std::ssize(extra), kChannels);
    for (std::size_t i = 0; i < extra.size(); ++i) {
      const std::array<double, kChannels> reading_V = Shown_V(i, spots[i], extra[i]);
      for (int c = 0; c < kChannels; ++c) shown_V(static_cast<Eigen::Index>(i), c) = reading_V[c];
    }
    return shown_V;
  }

  std::unique_ptr<model::Follow> On(const Scenario& changed) const override {
    Scenario stated = changed;
    stated.noise_free = noise_V_ == 0.0 && thermometer_noise_K_ == 0.0;
    return std::make_unique<RotaryFollow>(stated, record(), drives_);
  }

 private:
  /// X_LG, with the grating on its goniometer where the autocollimator saw it.
  Pose GratingPose(std::size_t i, const RotaryExtra& extra) const {
    const RecordedStop& stop = course_.stops[i];
    const Stand& stand = course_.stands[static_cast<std::size_t>(stop.mounting)];
    PoseState pose = Sum(stop.pose, extra.pose);
    pose.reference_error = pose.reference_error + mechanics::RotorToBase(extra.seat, -stop.moment.reference_rad);
    const auto at = [&] { return sim::GratingPose(stand, path_.effects(), stop.moment, stop.axes, pose); };
    if (!stop.swept) return at() * mechanics::ToPose(extra.mount);
    constexpr int kIterations = 3;  // each squares what is left of some milliradians
    for (int k = 0; k < kIterations; ++k) {
      const Vector3 normal_L = at().linear().col(1);
      pose.grating_yaw_rad += stop.seen_yaw_rad - std::atan2(-normal_L.x(), normal_L.y());
      pose.grating_tilt_rad +=
          stop.seen_tilt_rad - std::atan2(normal_L.z(), std::hypot(normal_L.x(), normal_L.y()));
    }
    return at() * mechanics::ToPose(extra.mount);
  }

  LightState LightAt(std::size_t i, const RotaryExtra& extra) const {
    LightState light = course_.stops[i].light;
    light.wavelength_m += extra.light.wavelength_m;
    light.yaw_rad += extra.light.yaw_rad;
    light.pitch_rad += extra.light.pitch_rad;
    return light;
  }

  std::vector<Spots> SpotsOf(const std::vector<RotaryExtra>& extra) const {
    std::vector<Pose> X_LG;
    std::vector<LightState> lights;
    for (std::size_t i = 0; i < extra.size(); ++i) {
      X_LG.push_back(GratingPose(i, extra[i]));
      lights.push_back(LightAt(i, extra[i]));
    }
    return path_.light().Trace(X_LG, lights);
  }

  std::array<double, kChannels> Shown_V(std::size_t i, const Spots& spots, const RotaryExtra& extra) const {
    const RecordedStop& stop = course_.stops[i];
    if (spots.status != ReadingStatus::kOk) return {kNaN, kNaN, kNaN, kNaN};
    std::array<double, kChannels> signal_V =
        path_.effects().Shown_V(stop.moment, path_.electronics().Amplify(spots.uv_m));
    for (int c = 0; c < kChannels; ++c) {
      const double sensitivity_V_m =
          (c < 2 ? RotaryOf(scenario()).psd_a : RotaryOf(scenario()).psd_b).sensitivity_V_m;
      signal_V[c] += stop.added_V[c] + sensitivity_V_m * extra.shown_m[c];
    }
    return ReadOut(path_.electronics().Expect(signal_V, stop.start, stop.n_samples, noise_V_));
  }

  std::array<double, kChannels> ReadOut(const std::array<double, kChannels>& mean_V) const {
    Acquisition block;
    for (int c = 0; c < kChannels; ++c) block.channel[c].mean_V = mean_V[c];
    path_.effects().AlterReadout(block);
    return {block.channel[0].mean_V, block.channel[1].mean_V, block.channel[2].mean_V, block.channel[3].mean_V};
  }

  double noise_V_, thermometer_noise_K_;  // as stated: what a step of the converter, or a log, is blurred by
  OpticalPath path_;
  std::shared_ptr<DrivesOnce> drives_;
  RotaryCourse course_;
};

}  // namespace

std::unique_ptr<model::Follow> FollowRotary(const Scenario& scenario, const std::vector<Reading>& record,
                                            std::shared_ptr<DrivesOnce> drives) {
  return Built(scenario.bench, [&] { return std::make_unique<RotaryFollow>(scenario, record, drives); });
}

}  // namespace twinbench::sim
