#include <algorithm>
#include <cmath>

#include "twin/benches/encoder_comparison/twin/effect.h"
#include "twin/core/units.h"
#include "twin/model/first_order_lag.h"

/// Causes that move the device's shaft against that of the reference, and those that read it at another time.
namespace twinbench::sim {
namespace {

/// The device counts too much for every turn, from where its reference starts to count, and more so turn by turn.
class Scale : public AngleEffect {
 public:
  explicit Scale(const EffectSettings& e) : ratio_(Parameter(e, "ratio")), curvature_(Parameter(e, "curvature")) {}
  double ShaftError_rad(const AngleMoment& moment) const override {
    return ratio_ * (1.0 + curvature_ * moment.read_rad / units::turn) * moment.read_rad;
  }

 private:
  double ratio_, curvature_;
};

/// Where the follower stands in the gap is its state. A gap that is crossed over another way than its width is one
/// with a soft end: a rubber, a belt, a wound-up shaft.
double Crossing_rad(const EffectSettings& e) {
  const double crossed_over_rad = Parameter(e, "crossed_over");
  return crossed_over_rad > 0.0 ? crossed_over_rad : std::abs(Parameter(e, "width"));
}

/// Play (Prandtl): the device's shaft rests until the gap is crossed and is then dragged along, half the gap
/// behind. With a negative width the reference is the one that is dragged.
class Gap : public AngleEffect {
 public:
  explicit Gap(const EffectSettings& e)
      : half_rad_(0.5 * Crossing_rad(e)),
        factor_(half_rad_ > 0.0 ? 0.5 * Parameter(e, "width") / half_rad_ : 0.0),
        start_(Parameter(e, "start")),
        approach_(Parameter(e, "approach")) {}
  void Advance(const AngleMoment& moment) override {
    if (!started_) follower_rad_ = moment.shaft_rad + start_ * half_rad_;
    started_ = true;
    Drag(moment.shaft_rad - approach_ * moment.approach_rad);
    Drag(moment.shaft_rad);
  }
  double ShaftError_rad(const AngleMoment& moment) const override {
    return factor_ * (follower_rad_ - moment.shaft_rad);
  }

 private:
  void Drag(double shaft_rad) {
    follower_rad_ = std::clamp(follower_rad_, shaft_rad - half_rad_, shaft_rad + half_rad_);
  }

  double half_rad_, factor_, start_, approach_;
  double follower_rad_ = 0.0;
  bool started_ = false;
};

/// The reading lags behind the motion; after a reversal the lag goes over to the other sense exponentially with the
/// way travelled.
class Hysteresis : public AngleEffect {
 public:
  explicit Hysteresis(const EffectSettings& e)
      : lag_rad_(Parameter(e, "lag")),
        settles_over_rad_(Parameter(e, "settles_over")),
        approach_(Parameter(e, "approach")),
        state_(Parameter(e, "start")) {}
  void Advance(const AngleMoment& moment) override {
    const double from_rad = moment.shaft_rad - approach_ * moment.approach_rad;
    if (!started_) last_rad_ = from_rad;
    started_ = true;
    Travel(from_rad);
    Travel(moment.shaft_rad);
  }
  double ShaftError_rad(const AngleMoment&) const override { return -lag_rad_ * state_; }

 private:
  void Travel(double to_rad) {
    const double way_rad = to_rad - last_rad_;
    last_rad_ = to_rad;
    if (way_rad == 0.0) return;
    const double sense = way_rad > 0.0 ? 1.0 : -1.0;
    state_ = sense + (state_ - sense) * std::exp(-std::abs(way_rad) / settles_over_rad_);
  }

  double lag_rad_, settles_over_rad_, approach_;
  double state_;  // -1 to 1
  double last_rad_ = 0.0;
  bool started_ = false;
};

/// Wound-up parts, a drive that creeps: behind by the same after every move, in its sense, and relaxing at rest.
class Settling : public AngleEffect {
 public:
  explicit Settling(const EffectSettings& e)
      : amplitude_rad_(Parameter(e, "amplitude")), time_constant_s_(Parameter(e, "time_constant")) {}
  void Advance(const AngleMoment& moment) override {
    constexpr double kStands_rad = 1e-3 * units::deg;  // a reference at rest moves by its noise
    const double way_rad = moment.shaft_rad - last_.shaft_rad;
    const bool came_back = moment.approach_rad * last_.approach_rad < 0.0;  // to the same stop
    if (!started_ || came_back || std::abs(way_rad) > kStands_rad) {
      state_ = Sense(moment.approach_rad != 0.0 ? moment.approach_rad : started_ ? way_rad : 0.0);
    } else {
      state_ *= std::exp(-ToSeconds(moment.now - last_.now) / time_constant_s_);
    }
    last_ = moment;
    started_ = true;
  }
  double ShaftError_rad(const AngleMoment&) const override { return -amplitude_rad_ * state_; }

 private:
  static double Sense(double way_rad) { return way_rad > 0.0 ? 1.0 : way_rad < 0.0 ? -1.0 : 0.0; }

  double amplitude_rad_, time_constant_s_;
  double state_ = 0.0;  // of what a move leaves, with its sense
  AngleMoment last_;
  bool started_ = false;
};

/// The device's reading is older than the reference's. A filter, or a servo in proportion to how far it is behind,
/// goes towards the shaft the faster the farther it is.
class Late : public AngleEffect {
 public:
  explicit Late(const EffectSettings& e) : age_s_(Parameter(e, "delay")), follower_(Parameter(e, "time_constant")) {}
  void Advance(const AngleMoment& moment) override {
    // From one measuring position to the next it has settled.
    const bool stands = moment.velocity_rad_s == 0.0 && last_.velocity_rad_s == 0.0;
    const bool is_elsewhere = stands && moment.shaft_rad != last_.shaft_rad;
    if (!has_begun_ || moment.setup != last_.setup || is_elsewhere)
      follower_.BeginInMotion(ToSeconds(moment.now), moment.shaft_rad, moment.velocity_rad_s);
    behind_rad_ = follower_.Next(ToSeconds(moment.now), moment.shaft_rad) - moment.shaft_rad;
    last_ = moment;
    has_begun_ = true;
  }
  double Age_s(const AngleMoment&) const override { return age_s_; }
  double Behind_rad(const AngleMoment&) const override { return behind_rad_; }

 private:
  double age_s_;
  model::FirstOrderLag follower_;
  AngleMoment last_;
  double behind_rad_ = 0.0;
  bool has_begun_ = false;
};

/// The device's clock runs fast: its readings are older and older.
class FastClock : public AngleEffect {
 public:
  explicit FastClock(const EffectSettings& e) : ratio_(Parameter(e, "ratio")) {}
  double Age_s(const AngleMoment& moment) const override { return ratio_ * ToSeconds(moment.now); }

 private:
  double ratio_;
};

/// Feedforward of the acceleration that is missing, or is too large.
class Inert : public AngleEffect {
 public:
  explicit Inert(const EffectSettings& e) : coefficient_s2_(Parameter(e, "coefficient")) {}
  double ShaftError_rad(const AngleMoment& moment) const override { return -coefficient_s2_ * moment.acceleration_rad_s2; }

 private:
  double coefficient_s2_;
};

/// What a controller needs to be behind by to push against friction; at rest it takes it away.
class Rubbing : public AngleEffect {
 public:
  explicit Rubbing(const EffectSettings& e) : lag_rad_(Parameter(e, "lag")) {}
  double ShaftError_rad(const AngleMoment& moment) const override { return -lag_rad_ * moment.goes; }

 private:
  double lag_rad_;
};

}  // namespace

AngleMakers ShaftEffects() {
  return {
      {"scale", Made<AngleEffect, Scale>},
      {"backlash", Made<AngleEffect, Gap>},
      {"hysteresis", Made<AngleEffect, Hysteresis>},
      {"settling", Made<AngleEffect, Settling>},
      {"latency", Made<AngleEffect, Late>},
      {"clock_rate", Made<AngleEffect, FastClock>},
      {"acceleration_error", Made<AngleEffect, Inert>},
      {"friction", Made<AngleEffect, Rubbing>},
  };
}

}  // namespace twinbench::sim
