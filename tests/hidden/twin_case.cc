#include "tests/hidden/twin_case.h"

#include "tests/hidden/alike.h"
#include "tests/hidden/effect_size.h"

namespace twinbench::hidden {
namespace {

std::vector<EffectSettings> DrawEffects(const std::vector<Wanted>& wanted, const Scenario& drawn,
                                        const SignatureScale& scale) {
  Stream stream(drawn.seed, "hidden.effect");
  std::vector<EffectSettings> effects;
  for (const Wanted& w : wanted) {
    EffectSettings effect = DrawEffect(w.effect, w.where, drawn, stream);
    for (const auto& [name, value] : w.parameters) effect.parameters.at(name) = value;
    effects.push_back(HasSize(w.effect, w.where, drawn.bench) ? SizedTo(w.rho, effect, drawn, scale) : effect);
  }
  return effects;
}

Hidden TruthOf(const std::vector<EffectSettings>& effects) {
  Hidden hidden;
  for (const EffectSettings& e : effects) hidden.causes.push_back({e.name, e.where, e.parameters});
  hidden.invisible = OnlyRelabels(effects.front().where);
  return hidden;
}

}  // namespace

Scenario HiddenBench(Design design, std::uint64_t seed, const std::vector<Wanted>& wanted,
                     const SignatureScale& scale, const Otherwise& otherwise) {
  Scenario actual = Drawn(design, seed);
  if (otherwise) otherwise(actual);
  actual.effects = DrawEffects(wanted, actual, scale);
  return actual;
}

Case MakeTwinCase(Design design, std::uint64_t seed, const std::vector<Wanted>& wanted, const SignatureScale& scale,
                  const Otherwise& otherwise) {
  const Scenario actual = HiddenBench(design, seed, wanted, scale, otherwise);
  Case made;
  made.scenario = Believed(design);
  made.readings = TakeReadings(actual);
  made.hidden = TruthOf(actual.effects);
  made.hidden.alike = AlikeOf(actual.effects.front(), Drawn(design, seed), scale);
  if (wanted.size() == 1 && HasSize(wanted.front().effect, wanted.front().where, actual.bench))
    made.hidden.rho = wanted.front().rho;
  return made;
}

}  // namespace twinbench::hidden
