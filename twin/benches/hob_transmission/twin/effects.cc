#include <cmath>
#include <complex>

#include "twin/benches/hob_transmission/settings.h"
#include "twin/benches/hob_transmission/twin/effect.h"
#include "twin/model/product.h"
#include "twin/sim/courses.h"
#include "twin/sim/effect_makers.h"
#include "twin/sim/outlier_draw.h"

namespace twinbench::sim {
namespace {

/// A ring that does not sit in the middle, is out of round or badly divided. The amplitude is that of what the head
/// sees, amplitude * cos(order * ring's angle + phase).
class RingError : public HobEffect {
 public:
  explicit RingError(const EffectSettings& e) : effect_(e) {}
  void AlterBench(Scenario& actual) const override {
    RingEncoderSettings& ring = effect_.where == "table" ? HobOf(actual).table_encoder : HobOf(actual).hob_encoder;
    if (effect_.name == "eccentricity") return MoveAside(ring);
    const double order = effect_.name == "ellipticity" ? 2.0 : Parameter(effect_, "order");
    ring.graduation.push_back(
        {Component::kEz, order, Parameter(effect_, "amplitude"), Parameter(effect_, "phase")});
  }

 private:
  /// A ring whose middle lies at azimuth A shows (a / R) sin(angle + A), to first order.
  void MoveAside(RingEncoderSettings& ring) const {
    const std::complex<double> there = std::polar(ring.eccentricity_m, ring.eccentricity_azimuth_rad);
    const double azimuth_rad = Parameter(effect_, "phase") + 0.5 * units::kPi;
    const std::complex<double> moved =
        there + Parameter(effect_, "amplitude") * ring.radius_m * std::polar(1.0, azimuth_rad);
    ring.eccentricity_m = std::abs(moved);
    ring.eccentricity_azimuth_rad = std::arg(moved);
  }

  EffectSettings effect_;
};

/// A gear that errs once a turn of the hob, of the worm, or with the teeth that the hob would cut.
class GearError : public HobEffect {
 public:
  GearError(const EffectSettings& e, const Scenario& scenario)
      : effect_(e), starts_(HobOf(scenario).transmission.hob_starts) {}
  void AlterGears(mechanics::GearErrors& errors) const override {
    const double amplitude_rad = Parameter(effect_, "amplitude"), phase_rad = Parameter(effect_, "phase");
    if (effect_.name == "worm") errors.worm.push_back({1.0, amplitude_rad, phase_rad});
    if (effect_.name == "hob_runout") errors.hob_drive.push_back({1.0, amplitude_rad, phase_rad});
    if (effect_.name == "gear_mesh")
      errors.hob_drive.push_back({static_cast<double>(starts_), amplitude_rad, phase_rad});
  }

 private:
  EffectSettings effect_;
  int starts_;
};

/// The table stays behind; after a reversal the lag goes over to the other sense exponentially with the way
/// travelled. A run starts without any.
class WindUp : public HobEffect {
 public:
  explicit WindUp(const EffectSettings& e)
      : lag_rad_(Parameter(e, "lag")), settles_over_rad_(Parameter(e, "settles_over")) {}
  void Travel(double table_rad) override {
    const double way_rad = table_rad - last_rad_;
    last_rad_ = table_rad;
    if (way_rad == 0.0) return;
    const double sense = way_rad > 0.0 ? 1.0 : -1.0;
    state_ = sense + (state_ - sense) * std::exp(-std::abs(way_rad) / settles_over_rad_);
  }
  ShownError Shown(const HobMoment&) override { return {.motion_rad = -lag_rad_ * state_}; }

 private:
  double lag_rad_, settles_over_rad_;
  double last_rad_ = 0.0;
  double state_ = 0.0;  // -1 to 1
};

ShownError Drift(const EffectSettings& e, const HobMoment& moment) {
  return {.motion_rad = DriftAt(e, moment.now)};
}

ShownError Step(const EffectSettings& e, const HobMoment& moment) {
  const double step_rad = StepAt(e, moment.reading);
  return e.where == "table" ? ShownError{.table_rad = step_rad} : ShownError{.hob_rad = step_rad};
}

ShownError Wave(const EffectSettings& e, const HobMoment& moment) {
  return {.motion_rad = WaveAt(e, moment.now)};
}

ShownError OldAngle(const EffectSettings& e, const HobMoment& moment) {
  return {.table_rad = -moment.velocity_rad_s * Parameter(e, "delay")};
}

/// An error of the counts as a function of the moment.
template <ShownError (*kCourse)(const EffectSettings&, const HobMoment&)>
class CountError : public HobEffect {
 public:
  explicit CountError(const EffectSettings& effect) : effect_(effect) {}
  ShownError Shown(const HobMoment& moment) override { return kCourse(effect_, moment); }

 private:
  EffectSettings effect_;
};

/// Sine and cosine of the hob's encoder are not what they should be.
class HobSignalFault : public HobEffect {
 public:
  explicit HobSignalFault(const EffectSettings& e) : effect_(e) {}
  void AlterHobSignals(mechanics::SignalState& signals) const override {
    if (effect_.name == "signal_offset") {
      signals.offset_sin += Parameter(effect_, "offset_sin");
      signals.offset_cos += Parameter(effect_, "offset_cos");
    }
    if (effect_.name == "amplitude_mismatch") signals.ratio += Parameter(effect_, "ratio");
    if (effect_.name == "quadrature_error") signals.quadrature_rad += Parameter(effect_, "angle");
  }

 private:
  EffectSettings effect_;
};

/// A product of what the table's encoder or the interferometer shows and a course.
class HobSignal : public HobEffect {
 public:
  HobSignal(const EffectSettings& effect, const Scenario& scenario) : product_(effect, FormatOf(scenario.bench)) {}

  ShownError Shown(const HobMoment& moment) override {
    if (moment.velocity_rad_s != 0.0) direction_ = std::copysign(1.0, moment.velocity_rad_s);
    const model::Instant instant{.time_s = ToSeconds(moment.now),
                                 .reading = moment.reading,
                                 .direction = direction_,
                                 .velocity_rad_s = moment.velocity_rad_s,
                                 .angle_rad = {moment.table_rad, 0.0}};
    const double added_rad = product_.At(instant, std::array{0.0, 0.0});
    const bool of_encoder = product_.Channel() == 0;
    return {.table_rad = of_encoder ? added_rad : 0.0, .interferometer_rad = of_encoder ? 0.0 : added_rad};
  }

 private:
  model::Product product_;
  double direction_ = 1.0;
};

/// A count that was caught while it changed.
class CounterOutliers : public HobEffect {
 public:
  CounterOutliers(const EffectSettings& e, const Scenario& scenario) : draw_(e, scenario.RunSeed()) {}
  ShownError Shown(const HobMoment& moment) override { return {.table_rad = draw_.At(moment.reading).size}; }

 private:
  OutlierDraw draw_;
};

}  // namespace

std::unique_ptr<HobEffect> MakeHobEffect(const EffectSettings& effect, const Scenario& scenario) {
  static const EffectMakers<HobEffect> makers = {
      {"eccentricity", Made<HobEffect, RingError>},
      {"ellipticity", Made<HobEffect, RingError>},
      {"periodic", Made<HobEffect, RingError>},
      {"signal_offset", Made<HobEffect, HobSignalFault>},
      {"amplitude_mismatch", Made<HobEffect, HobSignalFault>},
      {"quadrature_error", Made<HobEffect, HobSignalFault>},
      {"hob_runout", Made<HobEffect, GearError>},
      {"worm", Made<HobEffect, GearError>},
      {"gear_mesh", Made<HobEffect, GearError>},
      {"hysteresis", Made<HobEffect, WindUp>},
      {"latency", Made<HobEffect, CountError<OldAngle>>},
      {"drift", Made<HobEffect, CountError<Drift>>},
      {"slip", Made<HobEffect, CountError<Step>>},
      {"tone", Made<HobEffect, CountError<Wave>>},
      {"signal", Made<HobEffect, HobSignal>},
      {"outliers", Made<HobEffect, CounterOutliers>},
  };
  return MakeBy(makers, effect, scenario);
}

}  // namespace twinbench::sim
