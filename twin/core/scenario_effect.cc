#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/core/bench_format.h"
#include "twin/core/effect_catalogue.h"
#include "twin/core/errors.h"
#include "twin/core/nearest_key.h"
#include "twin/core/number_text.h"
#include "twin/core/scenario_reader.h"
#include "twin/core/scenario_values.h"
#include "twin/core/signal_effect.h"

namespace twinbench {
namespace {

std::vector<std::string> EffectNames(const std::string& bench) {
  std::vector<std::string> names;
  for (const EffectEntry& entry : EffectCatalogue(bench)) names.push_back(entry.name);
  return names;
}

/// "name, where ("psd_a" or "psd_b"), roll_mrad": what a block of this effect may have.
std::string EffectForm(const EffectEntry& entry) {
  std::string form = "name";
  if (!entry.places.empty()) form += fmt::format(", where ({})", Alternatives(entry.places));
  for (const EffectParameter& parameter : entry.parameters) form += ", " + parameter.Key();
  return form;
}

/// @throws InputError, naming the other bench if the effect is one of its.
[[noreturn]] void RefuseEffect(const TomlValue& value, const std::string& name, const std::string& bench) {
  for (const std::string& other : BenchNames()) {
    if (FindEffect(name, other))
      throw InputError(value.Where(), fmt::format("the effect {} belongs to the bench {}", name, other),
                       Alternatives(EffectNames(bench)));
  }
  throw InputError(value.Where(), fmt::format("unknown effect \"{}\"", name),
                   fmt::format("a known one; the nearest is \"{}\"", Nearest(name, EffectNames(bench))));
}

const EffectEntry& EntryOf(const TomlValue& block, const toml::table& table, const std::string& bench) {
  const toml::node* node = table.get("name");
  if (!node) throw InputError(block.Where(), "the effect has no name", Alternatives(EffectNames(bench)));
  const TomlValue value = block.With(*node);
  const std::string name = ReadText(value, "effect.name", {});
  if (const EffectEntry* entry = FindEffect(name, bench)) return *entry;
  RefuseEffect(value, name, bench);
}

std::string ReadPlace(const TomlValue& block, const toml::table& table, const EffectEntry& entry) {
  const std::string key = entry.name + ": where";
  const toml::node* node = table.get("where");
  if (node && entry.places.empty())
    throw InputError(block.With(*node).Where(), fmt::format("the effect {} takes no where", entry.name),
                     EffectForm(entry));
  if (node) return ReadText(block.With(*node), key, entry.places);
  if (entry.places.empty() || !entry.default_place.empty()) return entry.default_place;
  throw InputError(block.Where(), key + " is missing", Alternatives(entry.places));
}

constexpr const char* kLogEvidence = "log_evidence";
constexpr const char* kProbability = "probability";
constexpr const char* kProvenance = "provenance";

/// What a diagnosis may have written beside the parameters of an effect.
bool IsFindingKey(const std::string& key, const EffectEntry& entry) {
  const bool is_uncertainty = std::any_of(entry.parameters.begin(), entry.parameters.end(),
                                          [&](const EffectParameter& p) { return p.UncertaintyKey() == key; });
  return is_uncertainty || key == kLogEvidence || key == kProbability || key == kProvenance;
}

/// Keys that say which effect it is and where.
bool IsWord(const std::string& key, const EffectEntry& entry) {
  if (entry.name == kSignalEffect)
    return key == "name" || key == "point" || key == "signal" || key == "by" || key == "times";
  return key == "name" || key == "where";
}

void CheckEffectKeys(const TomlValue& block, const toml::table& table, const EffectEntry& entry,
                     const std::string& place) {
  for (const auto& [key, node] : table) {
    const std::string name(key.str());
    const auto parameter = std::find_if(entry.parameters.begin(), entry.parameters.end(),
                                        [&](const EffectParameter& p) { return p.Key() == name; });
    const bool known = parameter != entry.parameters.end();
    if (IsWord(name, entry) || (known && parameter->BelongsTo(place))) continue;
    if (IsFindingKey(name, entry)) continue;
    const std::string what = known ? fmt::format("the effect {} has no {} at {}", entry.name, name, place)
                                   : fmt::format("the effect {} has no {}", entry.name, name);
    throw InputError(block.With(node).Where(), what, EffectForm(entry));
  }
}

double ReadParameter(const TomlValue& block, const toml::table& table, const EffectParameter& p,
                     const std::string& effect) {
  const toml::node* node = table.get(p.Key());
  if (!node) return p.default_SI;
  // The bounds come back from SI: rounded, so that they read as they were written in the catalogue.
  const auto in_unit = [&](double value_SI) {
    return ParseNumber(fmt::format("{:.12g}", value_SI / p.to_SI)).value();
  };
  const Unit unit{p.unit == "1" ? "" : std::string_view(p.unit), p.to_SI};
  return ReadNumber(block.With(*node), effect + ": " + p.Key(), unit, {in_unit(p.lower_SI), in_unit(p.upper_SI)});
}

EffectFinding ReadFinding(const TomlValue& block, const EffectEntry& entry) {
  EffectFinding finding;
  const auto number = [&](const std::string& key, const Unit& unit, const Bounds& bounds, double& place) {
    if (const auto value = Inside(block, key)) place = ReadNumber(*value, entry.name + ": " + key, unit, bounds);
  };
  for (const EffectParameter& p : entry.parameters) {
    double u = kNaN;
    number(p.UncertaintyKey(), {p.unit == "1" ? "" : std::string_view(p.unit), p.to_SI}, {0.0}, u);
    if (!std::isnan(u)) finding.u[p.name] = u;
  }
  number(kLogEvidence, {}, {}, finding.log_evidence);
  number(kProbability, {}, {0.0, 1.0}, finding.probability);
  if (const auto value = Inside(block, kProvenance))
    finding.provenance = ReadText(*value, entry.name + ": " + kProvenance, {});
  return finding;
}

/// A word of a signal; missing only if it may be.
std::string ReadWord(const TomlValue& block, const std::string& key, const std::vector<std::string>& words,
                     bool may_be_missing) {
  if (const auto value = Inside(block, key)) return ReadText(*value, "signal: " + key, words);
  if (may_be_missing) return "";
  throw InputError(block.Where(), "the signal has no " + key, Alternatives(words));
}

EffectEntry ReadSignal(const TomlValue& block, const BenchFormat& bench, EffectSettings& effect) {
  effect.signal = ReadWord(block, "signal", SignalKinds(), false);
  effect.where = ReadWord(block, "point", bench.points, false);
  effect.times = ReadWord(block, "times", SignalFactors(), true);
  const std::vector<std::string> arguments = SignalArguments(effect.signal, bench);
  if (arguments.empty() && Inside(block, "by"))
    throw InputError(block.Where(), fmt::format("a signal \"{}\" goes by nothing", effect.signal), "no `by`");
  if (!arguments.empty()) effect.by = ReadWord(block, "by", arguments, false);
  return SignalEntry(effect.signal, effect.times, bench);
}

bool IsSignal(const TomlValue& block) {
  const auto name = Inside(block, "name");
  return name && name->node().is_string() && name->node().value<std::string>() == kSignalEffect;
}

}  // namespace

EffectSettings ReadEffect(const TomlValue& block, const std::string& bench) {
  const toml::table& table = *block.node().as_table();
  EffectSettings effect;
  const bool is_signal = IsSignal(block);
  const EffectEntry entry = is_signal ? ReadSignal(block, FormatOf(bench), effect) : EntryOf(block, table, bench);
  effect.name = entry.name;
  if (!is_signal) effect.where = ReadPlace(block, table, entry);
  effect.location = block.Where();
  CheckEffectKeys(block, table, entry, effect.where);
  for (const EffectParameter& parameter : entry.parameters)
    effect.parameters[parameter.name] = ReadParameter(block, table, parameter, entry.name);
  effect.finding = ReadFinding(block, entry);
  return effect;
}

}  // namespace twinbench
