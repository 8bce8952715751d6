#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/effect.h"
#include "twin/model/block_mean.h"
#include "twin/sim/first_order_lag.h"

/// Causes in where things stand and how they move: laser, tables, bearings, the grating and its mounting.
namespace twinbench::sim {
namespace {

/// The laser stands aside and still hits the nominal spot: the light comes in at an angle in the plane of
/// dispersion, positive when it comes from +x.
class IncidenceOffset : public Effect {
 public:
  explicit IncidenceOffset(const EffectSettings& e) : incidence_rad_(Parameter(e, "incidence")) {}
  void AlterBench(Scenario& actual) const override {
    const Vector3 from_spot_m = RotaryOf(actual).laser.position_m;
    RotaryOf(actual).laser.position_m = Eigen::AngleAxisd(-incidence_rad_, Vector3::UnitZ()) * from_spot_m;
    RotaryOf(actual).laser.yaw_rad -= incidence_rad_;
  }

 private:
  double incidence_rad_;
};

/// The target's bearing moves with about half the frequency of the rotor: a tilt that depends on the unwrapped
/// angle.
class BearingHalfFrequency : public Effect {
 public:
  explicit BearingHalfFrequency(const EffectSettings& e)
      : order_(Parameter(e, "order")), tilt_rad_(Parameter(e, "tilt")) {}
  void AlterBench(Scenario& actual) const override {
    RotaryOf(actual).target.half_frequency_order = order_;
    RotaryOf(actual).target.half_frequency_tilt_rad += tilt_rad_;
  }

 private:
  double order_;
  double tilt_rad_;
};

/// The servo brings one table to where its encoder shows the command, wrong by a sine within each period.
class EncoderSubdivision : public Effect {
 public:
  explicit EncoderSubdivision(const EffectSettings& e)
      : table_(e.where == "reference" ? 1 : 0), amplitude_rad_(Parameter(e, "amplitude")), location_(e.location) {}
  void AlterBench(Scenario& actual) const override {
    MechanicsSettings& mechanics = RotaryOf(actual).mechanics;
    double& error_rad = mechanics.encoder_subdivision_rad[table_];
    error_rad += amplitude_rad_;
    if (std::abs(error_rad) * mechanics.encoder_periods < 0.9) return;
    throw InputError(location_,
                     fmt::format("a subdivision error of {:.3g} arcsec turns a graduation of {} periods back",
                                 error_rad / units::arcsec, mechanics.encoder_periods),
                     fmt::format("less than {:.3g} arcsec", 0.9 / mechanics.encoder_periods / units::arcsec));
  }

 private:
  std::size_t table_;
  double amplitude_rad_;
  std::string location_;
};

/// The rotor of one table lags behind its drive by `half_width`, on the side it came from. A move takes up the play
/// before the rotor follows. (A servo that rings can carry a rotor over the play as well:
/// `target.backlash_arcsec`.)
class Backlash : public Effect {
 public:
  explicit Backlash(const EffectSettings& e)
      : table_(e.where == "reference" ? 1 : 0), half_width_rad_(Parameter(e, "half_width")) {}

  void Advance(const Moment& moment) override {
    if (moment.departed[table_] != departed_) before_rad_ = offset_rad_;
    departed_ = moment.departed[table_];
    const int direction = table_ == 1 ? moment.reference_direction : moment.target_direction;
    const double taken_up_rad = std::min(moment.travelled_rad[table_], 2.0 * half_width_rad_);
    offset_rad_ = std::clamp(before_rad_ - direction * taken_up_rad, -half_width_rad_, half_width_rad_);
  }
  void AlterPose(const Moment&, PoseState& pose) const override {
    (table_ == 1 ? pose.reference_yaw_rad : pose.target_yaw_rad) += offset_rad_;
  }

 private:
  std::size_t table_;
  double half_width_rad_;
  Time departed_ = Time::min();
  double before_rad_ = 0.0, offset_rad_ = 0.0;  // rotor against drive, before its last move and now
};

/// The target still creeps to its place after the move: behind by `amplitude` when the move has ended, decaying
/// exponentially. On the way it falls behind in proportion to the way.
class Settling : public Effect {
 public:
  explicit Settling(const EffectSettings& e)
      : amplitude_rad_(Parameter(e, "amplitude")), time_constant_s_(Parameter(e, "time_constant")) {}
  void AlterPose(const Moment& moment, PoseState& pose) const override {
    pose.target_yaw_rad -= moment.target_direction * amplitude_rad_ * ShareBehind(moment);
  }
  double Shortest_s() const override { return time_constant_s_; }

 private:
  double ShareBehind(const Moment& moment) const {
    const Time departed = std::max(moment.departed[0], moment.departed[1]);
    if (moment.now < moment.arrived) return ToSeconds(moment.now - departed) / ToSeconds(moment.arrived - departed);
    const double since_s = ToSeconds(moment.now - moment.arrived) + moment.lag_s;
    return model::DecayMeanBehindPole(since_s, time_constant_s_, moment.averaged_s, moment.lag_s);
  }

  double amplitude_rad_;
  double time_constant_s_;
};

/// The scenario says `reseat`, but the grating was re-clamped on the reference rotor: the reference's wobble then
/// turns with the set-up (docs/theory.md 3).
class ReclampFrame : public Effect {
 public:
  explicit ReclampFrame(const EffectSettings&) {}
  void AlterMounting(Mounting& mounting) const override {
    mounting.clamp_rad -= mounting.reseat_rad;
    mounting.reseat_rad = 0.0;
    mounting.body_reseated = false;
  }
};

/// The grating's mount creeps after every mounting: logarithmic in time, `amplitude` after e - 1 time constants.
class MountCreep : public Effect {
 public:
  explicit MountCreep(const EffectSettings& e)
      : yaw_(e.where == "yaw"),
        amplitude_rad_(Parameter(e, "amplitude")),
        time_constant_s_(Parameter(e, "time_constant")) {}
  void AlterPose(const Moment& moment, PoseState& pose) const override {
    const double angle_rad = amplitude_rad_ * std::log1p(ToSeconds(moment.now - moment.mounted) / time_constant_s_);
    (yaw_ ? pose.grating_yaw_rad : pose.grating_tilt_rad) += angle_rad;
  }

 private:
  bool yaw_;
  double amplitude_rad_;
  double time_constant_s_;
};

/// A post or the base bends with the room temperature, behind it by a first-order lag.
class ThermalTilt : public Effect {
 public:
  explicit ThermalTilt(const EffectSettings& e)
      : yaw_(e.where == "yaw"), tilt_per_kelvin_rad_(Parameter(e, "tilt_per_kelvin")), post_(Parameter(e, "lag")) {}

  void Advance(const Moment& moment) override {
    lagged_K_ = post_.Follow(ToSeconds(moment.now), moment.temperature_K);
  }
  void AlterPose(const Moment&, PoseState& pose) const override {
    (yaw_ ? pose.grating_yaw_rad : pose.grating_tilt_rad) += tilt_per_kelvin_rad_ * lagged_K_;
  }

 private:
  bool yaw_;
  double tilt_per_kelvin_rad_;
  FirstOrderLag post_;
  double lagged_K_ = 0.0;
};

/// Something was knocked at one reading and stays where it went: the grating in yaw or tilt, or along its normal.
class Slip : public Effect {
 public:
  explicit Slip(const EffectSettings& e)
      : where_(e.where), at_reading_(static_cast<int>(Parameter(e, "at_reading"))) {
    size_ = where_ == "lateral" ? Parameter(e, "shift") : Parameter(e, "angle");
  }
  void AlterPose(const Moment& moment, PoseState& pose) const override {
    if (moment.reading < at_reading_) return;
    if (where_ == "yaw") pose.grating_yaw_rad += size_;
    if (where_ == "tilt") pose.grating_tilt_rad += size_;
    if (where_ == "lateral") pose.grating_shift_m += size_;
  }

 private:
  std::string where_;
  int at_reading_;
  double size_;
};

}  // namespace

EffectMakers<Effect> PoseEffects() {
  return {
      {"incidence_offset", Made<Effect, IncidenceOffset>},
      {"bearing_half_frequency", Made<Effect, BearingHalfFrequency>},
      {"encoder_subdivision", Made<Effect, EncoderSubdivision>},
      {"backlash", Made<Effect, Backlash>},
      {"settling", Made<Effect, Settling>},
      {"reclamp_frame", Made<Effect, ReclampFrame>},
      {"mount_creep", Made<Effect, MountCreep>},
      {"thermal_tilt", Made<Effect, ThermalTilt>},
      {"slip", Made<Effect, Slip>},
  };
}

}  // namespace twinbench::sim
