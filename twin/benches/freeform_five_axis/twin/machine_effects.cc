#include <cmath>

#include "twin/benches/freeform_five_axis/twin/effect.h"
#include "twin/core/units.h"
#include "twin/sim/first_order_lag.h"
#include "twin/sim/outlier_draw.h"

/// Errors of the machine and of the artefact.
namespace twinbench::sim {
namespace {

/// Stretched along the artefact's x: a cell stands off its place, as if all of it had been moved under the probe.
class ArtefactPitch : public FreeformEffect {
 public:
  ArtefactPitch(const EffectSettings& e, const Scenario& scenario)
      : ratio_(Parameter(e, "ratio")), own_(FreeformOf(scenario)) {}
  void Disturb(const FreeformMoment& moment, FreeformExtra& extra) override {
    const auto setup = static_cast<std::size_t>(moment.setup);
    const std::vector<MountSettings>& mounts = own_.freeform_procedure.mounts;
    const double yaw_rad = setup < mounts.size() ? mounts[setup].yaw_rad : 0.0;
    const double off_m = ratio_ * moment.cell.i * own_.artefact.pitch_m;
    extra.slipped_S_m += off_m * Vector3(std::cos(yaw_rad), std::sin(yaw_rad), 0.0);
  }

 private:
  double ratio_;
  FreeformSettings own_;
};

/// Cells that stand higher and lower: one wave over the array.
class ArtefactForm : public FreeformEffect {
 public:
  ArtefactForm(const EffectSettings& e, const Scenario& scenario)
      : cosine_m_(Parameter(e, "cosine")),
        sine_m_(Parameter(e, "sine")),
        waves_(Parameter(e, "waves") *
               Eigen::Vector2d(std::cos(Parameter(e, "azimuth")), std::sin(Parameter(e, "azimuth")))),
        side_(2 * FreeformOf(scenario).artefact.cells + 1) {}
  void Disturb(const FreeformMoment& moment, FreeformExtra& extra) override {
    const double phase_rad = units::turn * (waves_.x() * moment.cell.i + waves_.y() * moment.cell.j) / side_;
    extra.cell_height_m += cosine_m_ * std::cos(phase_rad) + sine_m_ * std::sin(phase_rad);
  }

 private:
  double cosine_m_, sine_m_;
  Eigen::Vector2d waves_;
  int side_;
};

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

/// Of an axis, or picked up by the wires of one signal.
class Tone : public FreeformEffect {
 public:
  explicit Tone(const EffectSettings& e)
      : where_(e.where),
        axis_(AxisOf(e)),
        wave_(e, where_.starts_with("qpd") ? "_signal" : ""),
        frequency_Hz_(Parameter(e, "frequency")) {}
  void Disturb(const FreeformMoment& moment, FreeformExtra& extra) override {
    double& disturbed = where_ == "qpd_x"   ? extra.qpd_x_V
                        : where_ == "qpd_y" ? extra.qpd_y_V
                                            : OwnError(extra.machine, axis_);
    disturbed += wave_.At(frequency_Hz_ * moment.time_s);
  }

 private:
  std::string where_;
  std::size_t axis_;  // where it is one's
  WaveSize wave_;
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

EffectMakers<FreeformEffect> MachineEffects() {
  return {
      {"artefact_pitch", Made<FreeformEffect, ArtefactPitch>},
      {"artefact_form", Made<FreeformEffect, ArtefactForm>},
      {"cyclic", Made<FreeformEffect, Cyclic>},
      {"backlash", Made<FreeformEffect, AxisBacklash>},
      {"thermal_growth", Made<FreeformEffect, ThermalGrowth>},
      {"slip", Made<FreeformEffect, ArtefactSlip>},
      {"tone", Made<FreeformEffect, Tone>},
      {"outliers", Made<FreeformEffect, Outliers>},
  };
}

}  // namespace twinbench::sim
