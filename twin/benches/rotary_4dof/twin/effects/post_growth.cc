#include "twin/benches/rotary_4dof/twin/effects/effects.h"

namespace twinbench::sim {
namespace {

/// What a PSD stands on grows, and its spot goes down on it.
class PostGrowth : public Effect {
 public:
  explicit PostGrowth(const EffectSettings& e) : psd_(e.where), growth_m_K_(Parameter(e, "growth_per_kelvin")) {}
  void AlterBench(Scenario& actual) const override { PsdOf(actual, psd_).post_growth_m_K += growth_m_K_; }

 private:
  std::string psd_;
  double growth_m_K_;
};

}  // namespace

EffectPointer MakePostGrowth(const EffectSettings& settings, const Scenario& /*scenario*/) {
  return std::make_unique<PostGrowth>(settings);
}

}  // namespace twinbench::sim
