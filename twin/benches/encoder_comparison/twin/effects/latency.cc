#include "twin/benches/encoder_comparison/twin/effects/effects.h"

namespace twinbench::sim {
namespace {

/// The device's reading is older than the reference's; on a clock that runs fast more and more so.
class Late : public AngleEffect {
 public:
  /// @param per_s  By how much the age grows.
  Late(double age_s, double per_s) : begin_s_(age_s), per_s_(per_s) {}
  double Age_s(const AngleMoment& moment) const override { return begin_s_ + per_s_ * ToSeconds(moment.now); }

 private:
  double begin_s_, per_s_;
};

}  // namespace

AngleEffectPointer MakeLatency(const EffectSettings& settings) {
  return std::make_unique<Late>(Parameter(settings, "delay"), 0.0);
}

AngleEffectPointer MakeClockRate(const EffectSettings& settings) {
  return std::make_unique<Late>(0.0, Parameter(settings, "ratio"));
}

}  // namespace twinbench::sim
