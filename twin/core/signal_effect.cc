#include "twin/core/signal_effect.h"

#include <algorithm>
#include <map>

#include "twin/core/effect_entries.h"
#include "twin/core/errors.h"

namespace twinbench {
namespace {

std::string UnitOf(SignalKind kind) {
  if (kind == SignalKind::kOwn) return "1";
  return kind == SignalKind::kAngle ? "arcsec" : "um";
}

EffectParameter Amplitude(const BenchFormat& bench) {
  const bool angle = bench.signal == SignalKind::kAngle;
  return Signed("amplitude", UnitOf(bench.signal), 0.0, angle ? 3.6e6 : 1e5, "of the signal on its channel");
}

EffectParameter Length(const BenchFormat& bench, const std::string& name, const std::string& meaning) {
  return Parameter(name, UnitOf(bench.signal), 1.0, 1e-6, 1e9, meaning);
}

EffectParameter Phase() {
  return Signed("phase", "deg", 0.0, 360.0, "of amplitude * cos(... + phase)");
}

std::vector<EffectParameter> ParametersOf(const std::string& kind, const BenchFormat& bench) {
  const EffectParameter order = Parameter("order", "1", 1.0, 0.0, 1e5, "periods per turn of what it goes by");
  if (kind == "constant") return {Amplitude(bench)};
  if (kind == "harmonic") return {Amplitude(bench), order, Phase()};
  if (kind == "interaction")
    return {Amplitude(bench), order,
            Signed("with_order", "1", 1.0, 1e5, "periods per turn of the bench's second angle"), Phase()};
  if (kind == "tone")
    return {Amplitude(bench), Parameter("frequency", "Hz", 0.01, 1e-6, 1e6, "of the tone"), Phase()};
  if (kind == "step")
    return {Amplitude(bench), Parameter("at_reading", "1", 0.0, 0.0, 1e9, "first reading behind the step")};
  if (kind == "fringes") return {Amplitude(bench), Length(bench, "period", "of what the channel shows"), Phase()};
  if (kind == "power")
    return {Amplitude(bench),
            Parameter("exponent", "1", 3.0, 0.0, 9.0, "of what the channel shows, over the range"),
            Parameter("partner_exponent", "1", 0.0, 0.0, 9.0, "of what its detector's other channel shows"),
            Length(bench, "range", "that counts as one")};
  return {Signed("share", "1", 0.0, 10.0, "of what the channel named by `by` shows")};
}

/// Where the factor is zero and where it is one: (what is followed - about) / per.
std::vector<EffectParameter> FactorParameters(const std::string& times) {
  static const std::map<std::string, std::pair<std::string, double>> units = {{"velocity", {"deg_per_s", 1.0}},
                                                                              {"speed", {"deg_per_s", 1.0}},
                                                                              {"time", {"s", 1.0}},
                                                                              {"temperature", {"K", 1.0}}};
  const auto found = units.find(times);
  if (found == units.end()) return {};
  const auto& [unit, per] = found->second;
  return {Signed("about", unit, 0.0, 1e9, "of " + times + ": there the signal is zero"),
          Parameter("per", unit, per, 1e-12, 1e12, "change of " + times + " that makes it one")};
}

}  // namespace

std::vector<double>& ValuesOf(EmpiricalSettings& empirical, SignalKind kind) {
  if (kind == SignalKind::kOwn) return empirical.value;
  return kind == SignalKind::kAngle ? empirical.value_rad : empirical.value_m;
}

std::vector<std::string> SignalKinds() {
  return {"constant", "harmonic", "interaction", "tone", "step", "fringes", "power", "share"};
}

std::vector<std::string> SignalFactors() {
  return {"direction", "velocity", "speed", "time", "temperature"};
}

std::vector<std::string> SignalArguments(const std::string& kind, const BenchFormat& bench) {
  if (kind == "harmonic") return bench.angles;
  if (kind == "share") return bench.points;
  return {};
}

EffectEntry SignalEntry(const std::string& kind, const std::string& times, const BenchFormat& bench) {
  EffectEntry entry{kSignalEffect, "unmodelled effect: a signal at a point", bench.points,
                    ParametersOf(kind, bench)};
  std::ranges::move(FactorParameters(times), std::back_inserter(entry.parameters));
  return entry;
}

EffectEntry EntryOf(const EffectSettings& effect, const std::string& bench) {
  if (effect.name == kSignalEffect) return SignalEntry(effect.signal, effect.times, FormatOf(bench));
  const EffectEntry* entry = FindEffect(effect.name, bench);
  Require(entry != nullptr, "an effect of a scenario is in the catalogue");
  return *entry;
}

}  // namespace twinbench
