#include <cmath>

#include "twin/benches/freeform_five_axis/twin/effects/effects.h"
#include "twin/core/units.h"
#include "twin/sim/first_order_lag.h"
#include "twin/sim/outlier_draw.h"

namespace twinbench::sim {
namespace {

/// "x" to "b": 0 to 4.
std::size_t AxisOf(const EffectSettings& e) {
  return std::string("xyzab").find(e.where);
}

/// The error of an axis along or about itself: x.tx, y.ty, z.tz, a.rx, b.ry.
double& OwnError(MachineErrors& errors, std::size_t axis) {
  return errors.body[axis][axis];
}

/// `cosine` and `sine` of an effect.
struct WaveSize {
  double cosine, sine;
  explicit WaveSize(const EffectSettings& e, const std::string& more = "")
      : cosine(Parameter(e, ("cosine" + more).c_str())), sine(Parameter(e, ("sine" + more).c_str())) {}
  double At(double periods) const {
    return cosine * std::cos(units::turn * periods) + sine * std::sin(units::turn * periods);
  }
};

class Cyclic : public FreeformEffect {
 public:
  explicit Cyclic(const EffectSettings& e) : axis_(AxisOf(e)), wave_(e), pitch_m_(Parameter(e, "pitch")) {}
  void Disturb(const FreeformMoment& moment, FreeformExtra& extra) override {
    OwnError(extra.machine, axis_) += wave_.At(moment.at[axis_] / pitch_m_);
  }

 private:
  std::size_t axis_;
  WaveSize wave_;
  double pitch_m_;
};

class AxisBacklash : public FreeformEffect {
 public:
  explicit AxisBacklash(const EffectSettings& e)
      : axis_(AxisOf(e)), half_(Parameter(e, IsRotaryAxis(static_cast<int>(axis_)) ? "half_angle" : "half")) {}
  void Disturb(const FreeformMoment& moment, FreeformExtra& extra) override {
    const double moved = moment.at[axis_] - last_;  // NaN before the first: as if it had come from below
    if (moved < 0.0) sense_ = -1.0;
    if (moved > 0.0) sense_ = 1.0;
    last_ = moment.at[axis_];
    OwnError(extra.machine, axis_) -= sense_ * half_;
  }

 private:
  std::size_t axis_;
  double half_, sense_ = 1.0, last_ = kNaN;
};

/// The spindle on the Z slide grows.
class ThermalGrowth : public FreeformEffect {
 public:
  explicit ThermalGrowth(const EffectSettings& e)
      : along_(AxisOf(e)), growth_m_K_(Parameter(e, "growth")), spindle_(Parameter(e, "lag")) {}
  void Disturb(const FreeformMoment& moment, FreeformExtra& extra) override {
    extra.machine.body[2][along_] += growth_m_K_ * spindle_.Follow(moment.time_s, moment.above_K);
  }

 private:
  std::size_t along_;
  double growth_m_K_;
  FirstOrderLag spindle_;
};

/// Mounting the artefact anew ends it.
class ArtefactSlip : public FreeformEffect {
 public:
  explicit ArtefactSlip(const EffectSettings& e)
      : along_(static_cast<Eigen::Index>(AxisOf(e))),
        step_m_(Parameter(e, "step")),
        at_(Parameter(e, "at_reading")) {}
  void Disturb(const FreeformMoment& moment, FreeformExtra& extra) override {
    if (moment.reading < at_) return;
    if (setup_ < 0) setup_ = moment.setup;
    if (setup_ == moment.setup) extra.slipped_S_m[along_] += step_m_;
  }

 private:
  Eigen::Index along_;
  double step_m_, at_;
  int setup_ = -1;  // in which it slipped
};

class Tone : public FreeformEffect {
 public:
  explicit Tone(const EffectSettings& e) : axis_(AxisOf(e)), wave_(e), frequency_Hz_(Parameter(e, "frequency")) {}
  void Disturb(const FreeformMoment& moment, FreeformExtra& extra) override {
    OwnError(extra.machine, axis_) += wave_.At(frequency_Hz_ * moment.time_s);
  }

 private:
  std::size_t axis_;
  WaveSize wave_;
  double frequency_Hz_;
};

/// Picked up by the wires of one signal.
class SignalTone : public FreeformEffect {
 public:
  explicit SignalTone(const EffectSettings& e)
      : of_x_(e.where == "qpd_x"), wave_V_(e, "_signal"), frequency_Hz_(Parameter(e, "frequency")) {}
  void Disturb(const FreeformMoment& moment, FreeformExtra& extra) override {
    (of_x_ ? extra.qpd_x_V : extra.qpd_y_V) += wave_V_.At(frequency_Hz_ * moment.time_s);
  }

 private:
  bool of_x_;
  WaveSize wave_V_;
  double frequency_Hz_;
};

class Outliers : public FreeformEffect {
 public:
  Outliers(const EffectSettings& e, const Scenario& scenario) : draw_(e, scenario.RunSeed()) {}
  void Disturb(const FreeformMoment& moment, FreeformExtra& extra) override {
    OwnError(extra.machine, 1) += draw_.At(moment.reading).size;
  }

 private:
  OutlierDraw draw_;
};

}  // namespace

FreeformEffectPointer MakeCyclic(const EffectSettings& e) {
  return std::make_unique<Cyclic>(e);
}
FreeformEffectPointer MakeAxisBacklash(const EffectSettings& e) {
  return std::make_unique<AxisBacklash>(e);
}
FreeformEffectPointer MakeThermalGrowth(const EffectSettings& e) {
  return std::make_unique<ThermalGrowth>(e);
}
FreeformEffectPointer MakeArtefactSlip(const EffectSettings& e) {
  return std::make_unique<ArtefactSlip>(e);
}
FreeformEffectPointer MakeTone(const EffectSettings& e) {
  if (e.where.starts_with("qpd")) return std::make_unique<SignalTone>(e);
  return std::make_unique<Tone>(e);
}
FreeformEffectPointer MakeFreeformOutliers(const EffectSettings& e, const Scenario& scenario) {
  return std::make_unique<Outliers>(e, scenario);
}

}  // namespace twinbench::sim
