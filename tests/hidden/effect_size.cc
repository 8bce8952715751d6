#include "tests/hidden/twin_cases.h"

#include <limits>

#include "twin/benches/encoder_comparison/settings.h"
#include "twin/benches/hob_transmission/settings.h"
#include "twin/benches/names.h"
#include "twin/benches/turntable_autocollimator/settings.h"

namespace twinbench::hidden {
namespace {

/// Of benches whose catalogue begins with the size.
bool SizeComesFirst(const std::string& bench) { return bench == kCircularBench || bench == kFreeformBench; }

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

using units::deg;

/// Of effects that have such a parameter.
void Set(EffectSettings& effect, const std::string& name, double value) {
  const auto found = effect.parameters.find(name);
  if (found != effect.parameters.end()) found->second = value;
}

/// What a bench allows of shapes: readings early and late in a run, frequencies that its readings resolve [Hz].
struct Ranges {
  double first_reading, last_reading;
  double lowest_Hz, highest_Hz;
};

Ranges RangesOf(const std::string& bench) {
  if (bench == kRotaryBench) return {80.0, 560.0, 0.003, 0.06};
  if (bench == kTurntableBench) return {40.0, 260.0, 0.001, 0.02};
  if (bench == kHobBench) return {300.0, 2500.0, 0.05, 1.0};
  if (bench == kCircularBench) return {100.0, 850.0, 0.003, 0.06};
  if (bench == kFreeformBench) return {40.0, 280.0, 0.003, 0.06};
  return {40.0, 500.0, 0.003, 0.06};
}

/// Shapes that several effects share. All are drawn for each: what an effect gets does not depend on its
/// parameters.
void DrawShape(Stream& stream, const Ranges& ranges, EffectSettings& effect) {
  const bool settles = effect.name == "settling";
  Set(effect, "phase", UniformIn(stream, 0.0, 360.0) * deg);
  Set(effect, "curvature", UniformIn(stream, -0.3, 0.3));
  Set(effect, "at_voltage", UniformIn(stream, -0.01, 0.01));
  Set(effect, "frequency", LogUniformIn(stream, ranges.lowest_Hz, ranges.highest_Hz));
  Set(effect, "settles_over", LogUniformIn(stream, 10.0, 60.0) * deg);
  const double time_constant_s = settles ? UniformIn(stream, 0.5, 2.0) : LogUniformIn(stream, 200.0, 2000.0);
  if (effect.name != "latency") Set(effect, "time_constant", time_constant_s);  // that is a delay
  Set(effect, "at_reading", std::round(UniformIn(stream, ranges.first_reading, ranges.last_reading)));
}

void DrawOwnShape(Stream& stream, const Scenario& scenario, EffectSettings& effect) {
  if (effect.name == "thermal_tilt") Set(effect, "lag", LogUniformIn(stream, 300.0, 2700.0));
  if (effect.name == "bearing_half_frequency") Set(effect, "order", UniformIn(stream, 0.42, 0.499));
  const bool on_hob = effect.where == "hob";  // of its turns the readings resolve few periods
  if (effect.name == "periodic") Set(effect, "order", std::floor(UniformIn(stream, 5.0, on_hob ? 8.0 : 30.0)));
  if (effect.name == "autocollimator_periodic")
    Set(effect, "period", LogUniformIn(stream, 3.0, 40.0) * units::arcsec);
  if (effect.name == "multitooth_seating") Set(effect, "scatter", UniformIn(stream, 0.4, 0.8) * units::arcsec);
  if (effect.name == "reference_fault") Set(effect, "order", std::floor(UniformIn(stream, 1.0, 6.0)));
  if (effect.name == "gear_mesh" && scenario.bench == kEncoderBench)
    Set(effect, "teeth", EncoderOf(scenario).device.teeth);
}

void DrawOutliers(Stream& stream, double sigma, EffectSettings& effect) {
  Set(effect, "fraction", LogUniformIn(stream, 0.005, 0.03));
  Set(effect, "size", UniformIn(stream, 8.0, 20.0) * sigma);
}

/// Of the two machine tools.
void DrawMachineShape(Stream& stream, EffectSettings& effect) {
  Set(effect, "pitch", LogUniformIn(stream, 4.0, 20.0) * units::mm);
  Set(effect, "lag", LogUniformIn(stream, 200.0, 3000.0));
  Set(effect, "time", LogUniformIn(stream, 0.25, 1.0));
  Set(effect, "waves", UniformIn(stream, 1.0, 3.0));
  Set(effect, "azimuth", UniformIn(stream, -80.0, 80.0) * deg);
  if (effect.name == "ball_form") Set(effect, "order", 2.0 + std::floor(UniformIn(stream, 0.0, 2.0)));
}

/// Noise of one reading of a bench, m or rad.
double NoiseOf(const Scenario& scenario) {
  if (scenario.bench == kRotaryBench || scenario.bench == kCircularBench) return 0.3 * units::um;
  if (scenario.bench == kFreeformBench) return units::um;  // of the tip
  if (scenario.bench == kTurntableBench) return TurntableOf(scenario).autocollimator.noise_rad;
  return scenario.bench == kHobBench ? HobOf(scenario).table_encoder.noise_rad
                                     : EncoderOf(scenario).device.noise_rad;
}

void DrawSign(Stream& stream, const std::string& bench, EffectSettings& effect) {
  const std::string size = SizeParameter(effect.name, effect.where, bench);
  // A negative amplitude is a positive one at the opposite phase: only one of the two is drawn.
  const bool is_signed =
      CatalogueParameter(bench, effect.name, size).lower_SI < 0.0 && !effect.parameters.contains("phase");
  if (is_signed && stream.Uniform() < 0.5) effect.parameters.at(size) *= -1.0;
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

EffectSettings WithDefaults(const std::string& name, const std::string& where, const std::string& bench) {
  EffectSettings effect{name, where, {}, ""};
  for (const EffectParameter& p : FindEffect(name, bench)->parameters) {
    if (p.BelongsTo(where)) effect.parameters[p.name] = p.default_SI;
  }
  return effect;
}

EffectSettings DrawEffect(const std::string& name, const std::string& where, const Scenario& scenario,
                          Stream& stream) {
  EffectSettings effect = WithDefaults(name, where, scenario.bench);
  DrawShape(stream, RangesOf(scenario.bench), effect);
  DrawOwnShape(stream, scenario, effect);
  const bool is_machine_tool = scenario.bench == kCircularBench || scenario.bench == kFreeformBench;
  if (is_machine_tool) DrawMachineShape(stream, effect);
  if (is_machine_tool) TurnWave(UniformIn(stream, 0.0, units::turn), scenario.bench, effect);
  if (name == "outliers") DrawOutliers(stream, NoiseOf(scenario), effect);
  if (HasSize(name, where, scenario.bench)) DrawSign(stream, scenario.bench, effect);
  if (name == "signal_offset")
    effect.parameters["offset_cos"] = UniformIn(stream, -2.0, 2.0) * effect.parameters.at("offset_sin");
  return effect;
}

}  // namespace twinbench::hidden
