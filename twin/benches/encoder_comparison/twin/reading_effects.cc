#include <algorithm>
#include <cmath>

#include "twin/benches/encoder_comparison/settings.h"
#include "twin/benches/encoder_comparison/twin/effect.h"
#include "twin/core/units.h"
#include "twin/model/first_order_lag.h"
#include "twin/model/product.h"
#include "twin/sim/courses.h"
#include "twin/sim/outlier_draw.h"

/// Causes that alter what the device or its reference shows of an angle.
namespace twinbench::sim {
namespace {

/// Periods a turn of what repeats with the angle.
double OrderOf(const EffectSettings& e, const Scenario& scenario) {
  if (e.name == "eccentricity") return 1.0;
  if (e.name == "ellipticity") return 2.0;
  if (e.name == "periodic") return Parameter(e, "order");
  if (e.name == "gear_mesh") return Parameter(e, "teeth");
  if (EncoderOf(scenario).device.lines > 0) return Parameter(e, "order") * EncoderOf(scenario).device.lines;
  throw InputError(e.location, "the effect interpolation needs the lines of the scale",
                   "device.lines_per_turn above 0");
}

/// amplitude * cos(order * angle of the device's scale + phase): eccentricity, ellipticity, screws, lines, teeth.
class Harmonic : public AngleEffect {
 public:
  Harmonic(const EffectSettings& e, const Scenario& scenario)
      : order_(OrderOf(e, scenario)), amplitude_rad_(Parameter(e, "amplitude")), phase_rad_(Parameter(e, "phase")) {}
  double DeviceError_rad(const AngleMoment&, double device_rad) const override {
    return amplitude_rad_ * std::cos(order_ * device_rad + phase_rad_);
  }

 private:
  double order_, amplitude_rad_, phase_rad_;
};

/// Sine and cosine that are off centre, unequal, not a quarter period apart or cut off.
class SignalFault : public AngleEffect {
 public:
  explicit SignalFault(const EffectSettings& e) : settings_(e) {}
  void AlterSignals(SignalState& signals) const override {
    if (settings_.name == "signal_offset") {
      signals.offset_sin += Parameter(settings_, "offset_sin");
      signals.offset_cos += Parameter(settings_, "offset_cos");
    }
    if (settings_.name == "amplitude_mismatch") signals.ratio += Parameter(settings_, "ratio");
    if (settings_.name == "quadrature_error") signals.quadrature_rad += Parameter(settings_, "angle");
    if (settings_.name == "signal_clipping")
      signals.clip_level = std::min(signals.clip_level, Parameter(settings_, "level"));
  }

  double SignalZero_rad() const override {
    return settings_.name == "signal_offset" ? 0.0 : Parameter(settings_, "zero");
  }

 private:
  EffectSettings settings_;
};

/// The device's zero drifts with time; one that warms up settles.
class ZeroDrift : public AngleEffect {
 public:
  explicit ZeroDrift(const EffectSettings& e)
      : rate_rad_s_(Parameter(e, "rate")),
        curvature_(Parameter(e, "curvature")),
        warm_up_s_(Parameter(e, "warm_up")) {}
  double DeviceError_rad(const AngleMoment& moment, double) const override {
    const double t_s = ToSeconds(moment.now);
    if (warm_up_s_ > 0.0) return -rate_rad_s_ * warm_up_s_ * std::expm1(-t_s / warm_up_s_);
    return rate_rad_s_ * t_s * (1.0 + curvature_ * (1.0 - t_s / units::hour));
  }

 private:
  double rate_rad_s_, curvature_, warm_up_s_;
};

/// The device's zero or its scale follows the temperature of the room, or one that lags behind it.
class FollowsTemperature : public AngleEffect {
 public:
  explicit FollowsTemperature(const EffectSettings& e) : of_scale_(e.name == "scale_temperature"),
        per_K_(Parameter(e, of_scale_ ? "growth" : "coefficient")), followed_(Parameter(e, "lag")) {}
  void Advance(const AngleMoment& moment) override {
    above_K_ = followed_.Next(ToSeconds(moment.now), moment.above_K);
  }
  double ShaftError_rad(const AngleMoment& moment) const override {
    return of_scale_ ? per_K_ * above_K_ * moment.read_rad : 0.0;
  }
  double DeviceError_rad(const AngleMoment&, double) const override { return of_scale_ ? 0.0 : per_K_ * above_K_; }

 private:
  bool of_scale_;
  double per_K_;
  model::FirstOrderLag followed_;
  double above_K_ = 0.0;
};

/// The device's zero jumps at one reading and stays: a lost line, a coupling that gave way.
class ZeroSlip : public AngleEffect {
 public:
  explicit ZeroSlip(const EffectSettings& e) : effect_(e) {}
  double DeviceError_rad(const AngleMoment& moment, double) const override {
    return StepAt(effect_, moment.reading);
  }

 private:
  EffectSettings effect_;
};

/// A product of the device's angle and a course.
class AngleSignal : public AngleEffect {
 public:
  AngleSignal(const EffectSettings& effect, const Scenario& scenario)
      : product_(effect, FormatOf(scenario.bench)) {}

  double DeviceError_rad(const AngleMoment& moment, double device_rad) const override {
    const double way_rad = moment.approach_rad != 0.0 ? moment.approach_rad : moment.velocity_rad_s;
    const model::Instant instant{.time_s = ToSeconds(moment.now),
                                 .reading = moment.reading,
                                 .direction = way_rad == 0.0 ? 0.0 : std::copysign(1.0, way_rad),
                                 .velocity_rad_s = moment.velocity_rad_s,
                                 .above_K = moment.above_K,
                                 .angle_rad = {device_rad, moment.shaft_rad}};
    return product_.At(instant, std::array{device_rad});
  }

 private:
  model::Product product_;
};

/// The reference shows amplitude * cos(order * its angle + phase) too much. The device knows nothing of it, and a
/// device turned on the shaft does not turn it along.
class ReferenceFault : public AngleEffect {
 public:
  explicit ReferenceFault(const EffectSettings& e)
      : order_(Parameter(e, "order")),
        amplitude_rad_(Parameter(e, "amplitude")),
        phase_rad_(Parameter(e, "phase")) {}
  double ReferenceError_rad(const AngleMoment& moment) const override {
    return amplitude_rad_ * std::cos(order_ * moment.shaft_rad + phase_rad_);
  }

 private:
  double order_, amplitude_rad_, phase_rad_;
};

class AngleOutliers : public AngleEffect {
 public:
  AngleOutliers(const EffectSettings& e, const Scenario& scenario) : draw_(e, scenario.RunSeed()) {}
  double DeviceError_rad(const AngleMoment& moment, double) const override { return draw_.At(moment.reading).size; }

 private:
  OutlierDraw draw_;
};

}  // namespace

AngleMakers ReadingEffects() {
  return {
      {"eccentricity", Made<AngleEffect, Harmonic>},
      {"ellipticity", Made<AngleEffect, Harmonic>},
      {"periodic", Made<AngleEffect, Harmonic>},
      {"gear_mesh", Made<AngleEffect, Harmonic>},
      {"interpolation", Made<AngleEffect, Harmonic>},
      {"signal_offset", Made<AngleEffect, SignalFault>},
      {"amplitude_mismatch", Made<AngleEffect, SignalFault>},
      {"quadrature_error", Made<AngleEffect, SignalFault>},
      {"signal_clipping", Made<AngleEffect, SignalFault>},
      {"drift", Made<AngleEffect, ZeroDrift>},
      {"zero_temperature", Made<AngleEffect, FollowsTemperature>},
      {"scale_temperature", Made<AngleEffect, FollowsTemperature>},
      {"slip", Made<AngleEffect, ZeroSlip>},
      {"signal", Made<AngleEffect, AngleSignal>},
      {"reference_fault", Made<AngleEffect, ReferenceFault>},
      {"outliers", Made<AngleEffect, AngleOutliers>},
  };
}

}  // namespace twinbench::sim
