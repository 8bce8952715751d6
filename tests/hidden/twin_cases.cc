#include "tests/hidden/twin_cases.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

namespace twinbench::hidden {
namespace {

using units::deg;

struct Wanted {
  std::string effect, where;
  double rho = kNaN;
};

/// The parameter that an effect's signature grows with.
std::string SizeOf(const std::string& effect, const std::string& where) {
  static const std::map<std::string, std::string> sizes = {{"psd_gain", "gain_error"},
                                                           {"psd_roll", "roll"},
                                                           {"psd_nonlinearity", "cubic"},
                                                           {"stray_light", "fraction"},
                                                           {"psd_distance", "distance_error"},
                                                           {"wavelength_offset", "wavelength_error"},
                                                           {"incidence_offset", "incidence"},
                                                           {"wavelength_temperature", "wavelength_per_kelvin"},
                                                           {"laser_drift", "drift"},
                                                           {"mount_creep", "amplitude"},
                                                           {"thermal_tilt", "tilt_per_kelvin"},
                                                           {"settling", "amplitude"},
                                                           {"tone", "amplitude"},
                                                           {"bearing_half_frequency", "tilt"},
                                                           {"adc_step", "step"},
                                                           {"crosstalk", "fraction"},
                                                           {"eccentricity", "amplitude"},
                                                           {"ellipticity", "amplitude"},
                                                           {"signal_offset", "offset_sin"},
                                                           {"amplitude_mismatch", "ratio"},
                                                           {"quadrature_error", "angle"},
                                                           {"signal_clipping", "level"},
                                                           {"interpolation", "amplitude"},
                                                           {"latency", "delay"},
                                                           {"hysteresis", "lag"},
                                                           {"scale", "ratio"},
                                                           {"drift", "rate"},
                                                           {"periodic", "amplitude"},
                                                           {"gear_mesh", "amplitude"},
                                                           {"reference_fault", "amplitude"}};
  if (effect == "slip") return where == "lateral" ? "shift" : where.empty() ? "step" : "angle";
  if (effect == "backlash") return where.empty() ? "width" : "half_width";
  const auto found = sizes.find(effect);
  return found == sizes.end() ? "" : found->second;
}

/// Shapes differ from run to run.
void DrawShape(Stream& stream, const Scenario& scenario, EffectSettings& effect) {
  const auto set = [&effect](const std::string& name, double value) {
    const auto found = effect.parameters.find(name);
    if (found != effect.parameters.end()) found->second = value;
  };
  const bool rotary = scenario.bench == kRotaryBench;
  set("phase", UniformIn(stream, 0.0, 360.0) * deg);
  set("curvature", UniformIn(stream, -0.3, 0.3));
  set("at_voltage", UniformIn(stream, -0.01, 0.01));
  set("frequency", LogUniformIn(stream, 0.003, 0.06));
  set("settles_over", LogUniformIn(stream, 10.0, 60.0) * deg);
  set("time_constant",
      effect.name == "settling" ? UniformIn(stream, 0.5, 2.0) : LogUniformIn(stream, 200.0, 2000.0));
  set("at_reading", std::round(UniformIn(stream, rotary ? 80.0 : 40.0, rotary ? 560.0 : 500.0)));
  if (effect.name == "thermal_tilt") set("lag", LogUniformIn(stream, 300.0, 2700.0));
  if (effect.name == "bearing_half_frequency") set("order", UniformIn(stream, 0.42, 0.499));
  if (effect.name == "periodic") set("order", std::floor(UniformIn(stream, 5.0, 30.0)));
  if (effect.name == "reference_fault") set("order", std::floor(UniformIn(stream, 1.0, 6.0)));
  if (effect.name == "gear_mesh") set("teeth", scenario.device.teeth);
  if (effect.name == "outliers") {
    set("fraction", LogUniformIn(stream, 0.005, 0.03));
    const double sigma = rotary ? 0.3 * units::um : scenario.device.noise_rad;
    set("size", UniformIn(stream, 8.0, 20.0) * sigma);
  }
}

const EffectParameter& ParameterOf(const std::string& bench, const std::string& effect, const std::string& name) {
  const std::vector<EffectParameter>& all = FindEffect(effect, bench)->parameters;
  return *std::ranges::find(all, name, &EffectParameter::name);
}

EffectSettings DrawEffect(const std::string& name, const std::string& where, const Scenario& scenario,
                          Stream& stream) {
  EffectSettings effect;
  effect.name = name;
  effect.where = where;
  for (const EffectParameter& p : FindEffect(name, scenario.bench)->parameters) {
    if (p.BelongsTo(where)) effect.parameters[p.name] = p.default_SI;
  }
  DrawShape(stream, scenario, effect);
  const std::string size = SizeOf(name, where);
  if (size.empty()) return effect;
  // A negative amplitude is a positive one at the opposite phase: only one of the two is drawn.
  const bool is_signed =
      ParameterOf(scenario.bench, name, size).lower_SI < 0.0 && !effect.parameters.contains("phase");
  if (is_signed && stream.Uniform() < 0.5) effect.parameters[size] *= -1.0;
  if (name == "signal_offset")
    effect.parameters["offset_cos"] = UniformIn(stream, -2.0, 2.0) * effect.parameters[size];
  return effect;
}

/// The same effect, `factor` times as large, within the catalogue's bounds.
EffectSettings Scaled(EffectSettings effect, double factor, const std::string& bench) {
  const auto scale = [&](const std::string& name) {
    const EffectParameter& p = ParameterOf(bench, effect.name, name);
    double& value = effect.parameters.at(name);
    // Clipping grows with what is cut off.
    value = name == "level" ? 1.0 - factor * (1.0 - value) : factor * value;
    value = std::clamp(value, p.lower_SI, p.upper_SI);
  };
  scale(SizeOf(effect.name, effect.where));
  if (effect.name == "signal_offset") scale("offset_cos");
  return effect;
}

std::vector<Reading> NoiseFree(Scenario scenario, const std::vector<EffectSettings>& effects) {
  scenario.noise_free = true;
  scenario.effects = effects;
  return TakeReadings(scenario);
}

/// Brings the signature of an effect to the length `rho`.
EffectSettings SizedTo(double rho, EffectSettings effect, const Scenario& drawn, const SignatureScale& scale) {
  constexpr int kMostSteps = 4;  // one is enough where the signature is proportional to the size
  const std::vector<Reading> without = NoiseFree(drawn, {});
  for (int step = 0; step < kMostSteps; ++step) {
    const double factor = rho / scale.Rho(NoiseFree(drawn, {effect}), without);
    if (!std::isfinite(factor) || std::abs(factor - 1.0) < 0.03) break;
    effect = Scaled(effect, factor, drawn.bench);
  }
  return effect;
}

/// Labels of the positions: free errors of both tables are the same under other labels.
bool OnlyRelabels(const Wanted& wanted) {
  return wanted.where == "reverse_target" || wanted.where == "reverse_reference" || wanted.where == "index_offset";
}

Part PartOf(const EffectSettings& effect) {
  return {effect.name, effect.where, effect.parameters};
}

/// Knowledge section 2.8, and of the angle bench the causes of one order.
std::vector<std::string> AlikeOf(const std::string& effect) {
  const std::vector<std::vector<std::string>> sets = {{"psd_distance", "stray_light"},
                                                      {"eccentricity", "signal_offset"},
                                                      {"interpolation", "gear_mesh", "periodic"},
                                                      {"ellipticity", "amplitude_mismatch", "quadrature_error"}};
  for (const auto& set : sets) {
    if (std::ranges::find(set, effect) != set.end()) return set;
  }
  if (effect == "backlash") return {"backlash", "hysteresis"};  // that settles at once
  return {effect};
}

using SharedScale = std::shared_ptr<const SignatureScale>;

/// A hysteresis that settles within so few readings that no test would tell it from a gap of twice its lag.
bool IsLikeAGap(const EffectSettings& effect, const Scenario& drawn, const SignatureScale& scale) {
  constexpr double kTellable = 4.13;  // found in 80 % of cases at a test of 0.1 %
  if (effect.name != "hysteresis") return false;
  EffectSettings gap;
  gap.name = "backlash";
  gap.parameters["width"] = 2.0 * effect.parameters.at("lag");
  return scale.Rho(NoiseFree(drawn, {effect}), NoiseFree(drawn, {gap})) < kTellable;
}

Case MakeCase(Design design, std::uint64_t seed, const std::vector<Wanted>& wanted, const SharedScale& scale) {
  Case made;
  made.scenario = Believed(design);
  Scenario actual = Drawn(design, seed);
  Stream stream(seed, "hidden.effect");
  made.hidden.alike = AlikeOf(wanted.front().effect);
  for (const Wanted& w : wanted) {
    EffectSettings effect = DrawEffect(w.effect, w.where, actual, stream);
    if (HasSize(w.effect)) effect = SizedTo(w.rho, effect, Drawn(design, seed), *scale);
    if (IsLikeAGap(effect, Drawn(design, seed), *scale)) made.hidden.alike.push_back("backlash");
    made.hidden.causes.push_back(PartOf(effect));
    actual.effects.push_back(effect);
  }
  made.hidden.invisible = OnlyRelabels(wanted.front());
  if (wanted.size() == 1 && HasSize(wanted.front().effect)) made.hidden.rho = wanted.front().rho;
  made.readings = TakeReadings(actual);
  return made;
}

std::vector<std::string> PlacesOf(const EffectEntry& entry) {
  return entry.places.empty() ? std::vector<std::string>{""} : entry.places;
}

bool NeedsAllKnown(const std::string& effect) {
  return effect == "interpolation" || effect == "gear_mesh" || effect == "reference_fault";
}

/// Designs that can show an effect at all: a device at rest has no latency.
std::vector<Design> DesignsFor(const std::string& effect, const std::string& bench) {
  if (bench == kRotaryBench) return {Design::kRotary};
  if (effect == "latency") return {Design::kSweep};
  if (NeedsAllKnown(effect)) return {Design::kStopsAllKnown, Design::kSweepAllKnown};
  return {Design::kStops, Design::kSweep};
}

const char* NameOf(Design design) {
  switch (design) {
    case Design::kRotary:
      return "rotary";
    case Design::kStops:
      return "stops";
    case Design::kSweep:
      return "sweep";
    case Design::kStopsAllKnown:
      return "stops+";
    case Design::kSweepAllKnown:
      return "sweep+";
  }
  return "";
}

/// "rotary:psd_gain:psd_a_x:17": unique, and says what to expect before the case is made.
std::string CaseName(Design design, const Wanted& wanted, std::uint64_t seed) {
  return fmt::format("{}:{}:{}:{}", NameOf(design), wanted.effect, wanted.where, seed);
}

/// Scales of the designs that were asked for, each made once.
class Scales {
 public:
  explicit Scales(std::string cache_folder) : cache_folder_(std::move(cache_folder)) {}
  SharedScale Of(Design design) {
    SharedScale& scale = scales_[design];
    if (!scale) scale = std::make_shared<const SignatureScale>(design, cache_folder_);
    return scale;
  }

 private:
  std::string cache_folder_;
  std::map<Design, SharedScale> scales_;
};

/// One plan of each effect, place and design.
template <class Add>
void ForAll(const std::string& bench, const Add& add) {
  for (const EffectEntry& entry : EffectCatalogue(bench)) {
    for (const std::string& place : PlacesOf(entry)) {
      for (const Design design : DesignsFor(entry.name, bench)) add(entry.name, place, design);
    }
  }
}

double RhoOf(int magnitude, const TwinOptions& options) {
  const double at = (magnitude + 0.5) / options.magnitudes;
  return options.rho_from * std::pow(options.rho_to / options.rho_from, at);
}

}  // namespace

bool HasSize(const std::string& effect) {
  return effect != "outliers" && effect != "convention" && effect != "reclamp_frame";
}

std::vector<Plan> SinglePlans(const std::string& bench, const TwinOptions& options) {
  std::vector<Plan> plans;
  Scales scales(options.cache_folder);
  std::uint64_t seed = options.first_seed;
  ForAll(bench, [&](const std::string& effect, const std::string& place, Design design) {
    const SharedScale scale = scales.Of(design);
    const int sizes = HasSize(effect) || effect == "outliers" ? options.magnitudes : 1;
    for (int k = 0; k < sizes * options.seeds; ++k) {
      const Wanted wanted{effect, place, RhoOf(k / options.seeds, options)};
      ++seed;
      plans.push_back({"twin " + bench, CaseName(design, wanted, seed),
                       [=] { return MakeCase(design, seed, {wanted}, scale); }});
    }
  });
  return plans;
}

std::vector<Plan> PairPlans(int count, const TwinOptions& options) {
  std::vector<Plan> plans;
  Scales scales(options.cache_folder);
  const SharedScale scale = scales.Of(Design::kRotary);
  std::vector<Wanted> all;
  ForAll(kRotaryBench, [&](const std::string& effect, const std::string& place, Design) {
    if (HasSize(effect)) all.push_back({effect, place});
  });
  Stream stream(options.first_seed, "hidden.pairs");
  while (std::ssize(plans) < count) {
    const auto draw = [&] {
      return all[static_cast<std::size_t>(stream.Uniform() * static_cast<double>(all.size()))];
    };
    Wanted a = draw(), b = draw();
    if (a.effect == b.effect) continue;
    a.rho = LogUniformIn(stream, 10.0, options.rho_to);
    b.rho = LogUniformIn(stream, 10.0, options.rho_to);
    const std::uint64_t seed = 100000 + options.first_seed + plans.size();
    plans.push_back({"pairs", std::to_string(seed), [=] {
                       return MakeCase(Design::kRotary, seed, {a, b}, scale);
                     }});
  }
  return plans;
}

std::vector<Plan> LeaveOneOutPlans(const std::string& bench, const TwinOptions& options) {
  constexpr double kRho = 20.0;
  constexpr int kNullRuns = 200;  // at this size the alarm is no question
  std::vector<Plan> plans;
  Scales scales(options.cache_folder);
  std::uint64_t seed = 200000 + options.first_seed;
  ForAll(bench, [&](const std::string& effect, const std::string& place, Design design) {
    if (!HasSize(effect)) return;
    const SharedScale scale = scales.Of(design);
    for (int k = 0; k < options.seeds; ++k) {
      ++seed;
      const Wanted wanted{effect, place, kRho};
      plans.push_back({"leave-one-out", CaseName(design, wanted, seed), [=] {
                         Case made = MakeCase(design, seed, {wanted}, scale);
                         made.options.struck = {effect};
                         made.options.null_runs = kNullRuns;
                         return made;
                       }});
    }
  });
  return plans;
}

}  // namespace twinbench::hidden
