#include "twin/benches/encoder_comparison/twin/effects/effects.h"

namespace twinbench::sim {
namespace {

/// The device's reading is older than the reference's, so that it is behind in proportion to the speed.
class Latency : public AngleEffect {
 public:
  explicit Latency(const EffectSettings& e) : delay_s_(Parameter(e, "delay")) {}
  double ShaftError_rad(const AngleMoment& moment) const override { return -moment.velocity_rad_s * delay_s_; }

 private:
  double delay_s_;
};

}  // namespace

AngleEffectPointer MakeLatency(const EffectSettings& settings) {
  return std::make_unique<Latency>(settings);
}

}  // namespace twinbench::sim
