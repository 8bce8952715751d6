#include "tests/hidden/effect_size.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "twin/benches/names.h"

namespace twinbench::hidden {
namespace {

/// Of benches whose catalogue begins with the size.
bool SizeComesFirst(const std::string& bench) {
  return bench == kCircularBench || bench == kFreeformBench;
}

/// Parameters that are scaled with a size.
std::string PartnerOf(const std::string& size) {
  static const std::map<std::string, std::string> partners = {
      {"cosine", "sine"}, {"cosine_signal", "sine_signal"}, {"tilt_x", "tilt_y"}, {"offset_sin", "offset_cos"}};
  const auto found = partners.find(size);
  return found == partners.end() ? "" : found->second;
}

void Scale(EffectSettings& effect, const std::string& name, double factor, const std::string& bench) {
  const EffectParameter& p = CatalogueParameter(bench, effect.name, name);
  double& value = effect.parameters.at(name);
  // Clipping grows with what is cut off.
  value = name == "level" ? 1.0 - factor * (1.0 - value) : factor * value;
  value = std::clamp(value, p.lower_SI, p.upper_SI);
}

/// The same effect, `factor` times as large, within the catalogue's bounds.
EffectSettings Scaled(EffectSettings effect, double factor, const std::string& bench) {
  const std::string size = SizeParameter(effect.name, effect.where, bench), partner = PartnerOf(size);
  Scale(effect, size, factor, bench);
  if (effect.parameters.contains(partner)) Scale(effect, partner, factor, bench);
  return effect;
}

}  // namespace

std::string SizeParameter(const std::string& effect, const std::string& where, const std::string& bench) {
  static const std::set<std::string> waves = {"order", "teeth", "frequency"};
  static const std::set<std::string> none = {"outliers", "multitooth_seating", "grating_form",
                                             "encoder_subdivision"};
  if (none.contains(effect)) return "";
  for (const EffectParameter& p : FindEffect(effect, bench)->parameters) {
    if (p.BelongsTo(where) && !waves.contains(p.name)) return p.name;
  }
  return "";
}

bool HasSize(const std::string& effect, const std::string& where, const std::string& bench) {
  return !SizeParameter(effect, where, bench).empty();
}

void TurnWave(double phase_rad, const std::string& bench, EffectSettings& effect) {
  const std::string size = SizeParameter(effect.name, effect.where, bench), partner = PartnerOf(size);
  if (!SizeComesFirst(bench) || !effect.parameters.contains(partner)) return;
  double &cosine = effect.parameters.at(size), &sine = effect.parameters.at(partner);
  const double amplitude = std::hypot(cosine, sine);
  cosine = amplitude * std::cos(phase_rad);
  sine = amplitude * std::sin(phase_rad);
}

const EffectParameter& CatalogueParameter(const std::string& bench, const std::string& effect,
                                          const std::string& name) {
  return *std::ranges::find(FindEffect(effect, bench)->parameters, name, &EffectParameter::name);
}

std::vector<Reading> NoiseFree(Scenario scenario, const std::vector<EffectSettings>& effects) {
  scenario.noise_free = true;
  scenario.effects = effects;
  return TakeReadings(scenario);
}

EffectSettings SizedTo(double rho, EffectSettings effect, const Scenario& drawn, const SignatureScale& scale) {
  // One step is enough where the signature is proportional to the size. Where it begins at once - a clipping that
  // stops are near or not - steps leap over it, and halving between those that are known leads there.
  constexpr int kMostSteps = 4, kMostHalvings = 12;
  constexpr double kClose = 0.03;
  const std::vector<Reading> without = NoiseFree(drawn, {});
  double size = 1.0, smaller = 0.0, larger = std::numeric_limits<double>::infinity();
  const auto is_bracketed = [&] { return smaller > 0.0 && std::isfinite(larger); };
  for (int step = 0; step < (is_bracketed() ? kMostHalvings : kMostSteps); ++step) {
    const double factor = rho / scale.Rho(NoiseFree(drawn, {effect}), without, drawn.seed);
    if (std::abs(factor - 1.0) < kClose) break;
    (factor > 1.0 ? smaller : larger) = size;
    const bool leaps = !(factor * size > smaller && factor * size < larger);
    if (leaps && !is_bracketed()) break;
    const double next = leaps ? std::sqrt(smaller * larger) : factor * size;
    effect = Scaled(effect, next / size, drawn.bench);
    size = next;
  }
  return effect;
}

}  // namespace twinbench::hidden
