#include <algorithm>
#include <utility>

#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/effects/effects.h"

namespace twinbench::sim {
namespace {

/// Wires and labels that are not what everybody believes: exchanged channels, inverted signs, a scale that counts
/// the other way round or starts one step too late.
class Convention : public Effect {
 public:
  Convention(const EffectSettings& e, const Scenario& scenario)
      : where_(e.where), step_rad_(2.0 * units::kPi / RotaryOf(scenario).procedure.positions) {}
  void AlterLabels(double& target_rad, double& reference_rad) const override {
    if (where_ == "reverse_target") target_rad = -target_rad;
    if (where_ == "reverse_reference") reference_rad = -reference_rad;
    if (where_ == "index_offset") target_rad += step_rad_;
  }
  void AlterReadout(Acquisition& block) const override {
    if (where_ == "swap_xy_a") Exchange(block, 0, 1);
    if (where_ == "swap_xy_b") Exchange(block, 2, 3);
    if (where_ == "swap_psds") {
      Exchange(block, 0, 2);
      Exchange(block, 1, 3);
    }
    if (where_.starts_with("negate_")) Negate(block, ChannelIndex(where_.substr(7)));
  }

 private:
  static void Exchange(Acquisition& block, int a, int b) {
    std::swap(block.channel[a], block.channel[b]);
    for (std::size_t scan = 0; scan + kChannels <= block.raw.size(); scan += kChannels) {
      std::swap(block.raw[scan + a], block.raw[scan + b]);
    }
  }
  static void Negate(Acquisition& block, int c) {
    ChannelBlock& channel = block.channel[c];
    channel = {-channel.mean_V, channel.std_V, -channel.max_V, -channel.min_V};
    // Code -32768 has no negative: it becomes the other end of the range, as an inverting amplifier would give.
    for (std::size_t k = c; k < block.raw.size(); k += kChannels) {
      block.raw[k] = static_cast<std::int16_t>(-std::max<int>(block.raw[k], -32767));
    }
  }

  std::string where_;
  double step_rad_;
};

}  // namespace

EffectPointer MakeConvention(const EffectSettings& settings, const Scenario& scenario) {
  return std::make_unique<Convention>(settings, scenario);
}

}  // namespace twinbench::sim
