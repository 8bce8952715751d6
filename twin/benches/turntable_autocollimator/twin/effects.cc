#include <cmath>

#include "twin/benches/turntable_autocollimator/settings.h"
#include "twin/benches/turntable_autocollimator/twin/effect.h"
#include "twin/model/product.h"
#include "twin/sim/courses.h"
#include "twin/sim/effect_makers.h"
#include "twin/sim/outlier_draw.h"

namespace twinbench::sim {
namespace {

/// `value` on the axis that the effect names.
Eigen::Vector2d OnAxis(const std::string& where, double value) {
  return where == "x" ? Eigen::Vector2d(value, 0.0) : Eigen::Vector2d(0.0, value);
}

void ChangeScale(const EffectSettings& e, Scenario& actual) {
  const double factor = (1.0 + TurntableOf(actual).autocollimator.gain_error) * (1.0 + Parameter(e, "gain_error"));
  TurntableOf(actual).autocollimator.gain_error = factor - 1.0;
}

void ChangeSeating(const EffectSettings& e, Scenario& actual) {
  double& sd_rad = TurntableOf(actual).multitooth_table.repeatability_sd[static_cast<std::size_t>(Component::kEz)];
  sd_rad = std::hypot(sd_rad, Parameter(e, "scatter"));
}

/// A constant of the bench that is not what the scenario says.
template <void (*kChange)(const EffectSettings&, Scenario&)>
class WrongConstant : public TurntableEffect {
 public:
  explicit WrongConstant(const EffectSettings& effect) : effect_(effect) {}
  void AlterBench(Scenario& actual) const override { kChange(effect_, actual); }

 private:
  EffectSettings effect_;
};

/// The turntable stays behind by half of a gap, in whichever direction it comes.
class TurntableBacklash : public TurntableEffect {
 public:
  explicit TurntableBacklash(const EffectSettings& e) : width_rad_(Parameter(e, "width")) {}
  double Yaw_rad(const TurntableMoment& moment) const override { return -0.5 * moment.direction * width_rad_; }

 private:
  double width_rad_;
};

/// The turntable still creeps to its place after the move: behind by `amplitude`, decaying exponentially.
class TurntableSettling : public TurntableEffect {
 public:
  explicit TurntableSettling(const EffectSettings& e)
      : amplitude_rad_(Parameter(e, "amplitude")), time_constant_s_(Parameter(e, "time_constant")) {}
  double Yaw_rad(const TurntableMoment& moment) const override {
    const double since_s = ToSeconds(moment.now - moment.arrived);
    return -moment.direction * amplitude_rad_ * std::exp(-since_s / time_constant_s_);
  }

 private:
  double amplitude_rad_, time_constant_s_;
};

/// The camera's interpolation between its pixels errs with their period.
class PixelPeriod : public TurntableEffect {
 public:
  explicit PixelPeriod(const EffectSettings& e)
      : where_(e.where),
        amplitude_rad_(Parameter(e, "amplitude")),
        period_rad_(Parameter(e, "period")),
        phase_rad_(Parameter(e, "phase")) {}
  Eigen::Vector2d ReadingError_rad(const TurntableMoment&, const Eigen::Vector2d& reading_rad) const override {
    const double shown_rad = where_ == "x" ? reading_rad.x() : reading_rad.y();
    const double phase_rad = 2.0 * units::kPi * shown_rad / period_rad_ + phase_rad_;
    return OnAxis(where_, amplitude_rad_ * std::cos(phase_rad));
  }

 private:
  std::string where_;
  double amplitude_rad_, period_rad_, phase_rad_;
};

double DriftingZero(const EffectSettings& e, const TurntableMoment& moment) {
  return DriftAt(e, moment.now);
}

/// The mounting creeps: logarithmic in time since it was made.
double CreepingZero(const EffectSettings& e, const TurntableMoment& moment) {
  return Parameter(e, "amplitude") *
         std::log1p(ToSeconds(moment.now - moment.mounted) / Parameter(e, "time_constant"));
}

double SteppingZero(const EffectSettings& e, const TurntableMoment& moment) {
  return StepAt(e, moment.reading);
}

double WavingZero(const EffectSettings& e, const TurntableMoment& moment) {
  return WaveAt(e, moment.now);
}

/// The zero of one axis as a function of the moment.
template <double (*kCourse)(const EffectSettings&, const TurntableMoment&)>
class MovingZero : public TurntableEffect {
 public:
  explicit MovingZero(const EffectSettings& effect) : effect_(effect) {}
  Eigen::Vector2d ReadingError_rad(const TurntableMoment& moment, const Eigen::Vector2d&) const override {
    return OnAxis(effect_.where, kCourse(effect_, moment));
  }

 private:
  EffectSettings effect_;
};

/// A product of an axis of the autocollimator and a course.
class AutocollimatorSignal : public TurntableEffect {
 public:
  AutocollimatorSignal(const EffectSettings& effect, const Scenario& scenario)
      : product_(effect, FormatOf(scenario.bench)) {}

  Eigen::Vector2d ReadingError_rad(const TurntableMoment& moment,
                                   const Eigen::Vector2d& reading_rad) const override {
    const model::Instant instant{.time_s = ToSeconds(moment.now),
                                 .reading = moment.reading,
                                 .direction = static_cast<double>(moment.direction),
                                 .above_K = moment.above_K,
                                 .angle_rad = {moment.turntable_rad, moment.multitooth_rad}};
    return product_.At(instant, std::array{reading_rad.x(), reading_rad.y()}) *
           Eigen::Vector2d::Unit(product_.Channel());
  }

 private:
  model::Product product_;
};

/// A draught in the beam disturbs one axis.
class AutocollimatorOutliers : public TurntableEffect {
 public:
  AutocollimatorOutliers(const EffectSettings& e, const Scenario& scenario) : draw_(e, scenario.RunSeed()) {}
  Eigen::Vector2d ReadingError_rad(const TurntableMoment& moment, const Eigen::Vector2d&) const override {
    const OutlierDraw::Drawn drawn = draw_.At(moment.reading);
    return OnAxis(drawn.uniform < 0.5 ? "x" : "y", drawn.size);
  }

 private:
  OutlierDraw draw_;
};

}  // namespace

std::unique_ptr<TurntableEffect> MakeTurntableEffect(const EffectSettings& effect, const Scenario& scenario) {
  static const EffectMakers<TurntableEffect> makers = {
      {"autocollimator_scale", Made<TurntableEffect, WrongConstant<ChangeScale>>},
      {"multitooth_seating", Made<TurntableEffect, WrongConstant<ChangeSeating>>},
      {"autocollimator_periodic", Made<TurntableEffect, PixelPeriod>},
      {"autocollimator_drift", Made<TurntableEffect, MovingZero<DriftingZero>>},
      {"mount_creep", Made<TurntableEffect, MovingZero<CreepingZero>>},
      {"slip", Made<TurntableEffect, MovingZero<SteppingZero>>},
      {"tone", Made<TurntableEffect, MovingZero<WavingZero>>},
      {"signal", Made<TurntableEffect, AutocollimatorSignal>},
      {"backlash", Made<TurntableEffect, TurntableBacklash>},
      {"settling", Made<TurntableEffect, TurntableSettling>},
      {"outliers", Made<TurntableEffect, AutocollimatorOutliers>},
  };
  return MakeBy(makers, effect, scenario);
}

}  // namespace twinbench::sim
