#include <array>

#include "twin/benches/freeform_five_axis/twin/effect.h"
#include "twin/core/units.h"
#include "twin/model/product.h"

/// Faults of the detectors.
namespace twinbench::sim {
namespace {

/// Too large, or part of the light on a fixed place: to the run itself the two are hardly different.
class GainOrLeakage : public FreeformEffect {
 public:
  explicit GainOrLeakage(const EffectSettings& e) : of_x_(e.where == "qpd_x") {
    if (e.name == "leakage") {
      const double fraction = Parameter(e, "fraction");
      factor_ = 1.0 - fraction;
      offset_V_ = fraction * Parameter(e, "at");
    } else {
      factor_ = 1.0 + Parameter(e, "ratio");
    }
  }
  void AlterSignals(const FreeformMoment&, ProbeSignals& shown) const override {
    double& one_V = of_x_ ? shown.qpd_x_V : shown.qpd_y_V;
    one_V = factor_ * one_V + offset_V_;
  }

 private:
  bool of_x_;
  double factor_ = 1.0, offset_V_ = 0.0;
};

class SpotDrift : public FreeformEffect {
 public:
  explicit SpotDrift(const EffectSettings& e) : along_(e.where == "qpd_x" ? 0 : 1), spot_m_(Parameter(e, "spot")) {}
  void Disturb(const FreeformMoment& moment, FreeformExtra& extra) override {
    extra.spot_m[along_] += spot_m_ * moment.run_share;
  }

 private:
  Eigen::Index along_;
  double spot_m_;
};

/// The axes of its signals are turned, with the detector or where they are added up: a spot that goes along the
/// tool's y is seen to go towards x, too.
class AxesTurned : public FreeformEffect {
 public:
  explicit AxesTurned(const EffectSettings& e) : roll_(Parameter(e, "roll")) {}
  void AlterSignals(const FreeformMoment&, ProbeSignals& shown) const override {
    const Eigen::Vector2d turned = roll_.inverse() * Eigen::Vector2d(shown.qpd_x_V, shown.qpd_y_V);
    shown.qpd_x_V = turned.x();
    shown.qpd_y_V = turned.y();
  }

 private:
  Eigen::Rotation2Dd roll_;
};

class CameraFault : public FreeformEffect {
 public:
  CameraFault(const EffectSettings& e, const Scenario& scenario)
      : bends_(e.name == "ccd_nonlinearity"),
        size_(Parameter(e, bends_ ? "bend" : "per_spot")),
        centre_px_(FreeformOf(scenario).ccd.centre_px) {}
  void AlterSignals(const FreeformMoment&, ProbeSignals& shown) const override {
    const double off_px = shown.ccd_px - centre_px_;
    shown.ccd_px += size_ * (bends_ ? off_px * off_px : shown.qpd_x_V / shown.qpd_sum_V);
  }

 private:
  bool bends_;
  double size_, centre_px_;
};

/// A product of what is shown, the angles A and B, or neither, and a course.
class Signal : public FreeformEffect {
 public:
  Signal(const EffectSettings& effect, const Scenario& scenario) : product_(effect, FormatOf(scenario.bench)) {}
  void AlterSignals(const FreeformMoment& moment, ProbeSignals& shown) const override {
    const model::Instant now{.time_s = moment.time_s,
                             .reading = moment.reading,
                             .direction = moment.direction,
                             .above_K = moment.above_K,
                             .angle_rad = {moment.at[3], moment.at[4]}};
    const std::array<double*, 3> channels = {&shown.qpd_x_V, &shown.qpd_y_V, &shown.ccd_px};
    *channels.at(static_cast<std::size_t>(product_.Channel())) +=
        product_.At(now, std::array{shown.qpd_x_V, shown.qpd_y_V, shown.ccd_px});
  }

 private:
  model::Product product_;
};

}  // namespace

EffectMakers<FreeformEffect> DetectorEffects() {
  return {
      {"qpd_gain", Made<FreeformEffect, GainOrLeakage>},
      {"leakage", Made<FreeformEffect, GainOrLeakage>},
      {"laser_drift", Made<FreeformEffect, SpotDrift>},
      {"qpd_roll", Made<FreeformEffect, AxesTurned>},
      {"ccd_nonlinearity", Made<FreeformEffect, CameraFault>},
      {"slope_crosstalk", Made<FreeformEffect, CameraFault>},
      {"signal", Made<FreeformEffect, Signal>},
  };
}

}  // namespace twinbench::sim
