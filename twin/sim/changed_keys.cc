#include "twin/sim/changed_keys.h"

#include <algorithm>
#include <span>
#include <variant>

#include "twin/core/effect_catalogue.h"
#include "twin/core/errors.h"
#include "twin/core/scenario_schema.h"
#include "twin/sim/effect_parameter.h"

namespace twinbench::sim {
namespace {

std::span<double> NumbersOf(const Field& field) {
  if (const auto* const one = std::get_if<double*>(&field)) return {*one, 1};
  if (const auto* const list = std::get_if<std::span<double>>(&field)) return *list;
  const auto* const list = std::get_if<std::vector<double>*>(&field);
  Require(list, "an effect changes numbers only");
  return **list;
}

/// "gain_error[@]" is an entry, "vertex_radius_mm" all of a list.
std::span<double> NumbersAt(const std::vector<ScenarioKey>& keys, std::string key, const EffectSettings& effect,
                            const EffectEntry& entry) {
  const bool is_entry = key.ends_with("[@]");
  if (is_entry) key.resize(key.size() - 3);
  if (const auto at = key.find('@'); at != std::string::npos) key.replace(at, 1, effect.where);
  const auto found = std::ranges::find(keys, key, &ScenarioKey::Path);
  Require(found != keys.end(), "an effect changes a key that its bench has");
  const std::span<double> numbers = NumbersOf(found->field);
  if (!is_entry) return numbers;
  const auto place = std::ranges::find(entry.places, effect.where) - entry.places.begin();
  return numbers.subspan(static_cast<std::size_t>(place), 1);
}

void Change(KeyChange::How how, double by, double& number) {
  if (how == KeyChange::How::kAdd) number += by;
  if (how == KeyChange::How::kMultiply) number *= 1.0 + by;
  if (how == KeyChange::How::kDivide) number /= 1.0 + by;
}

/// A change by one block of the scenario.
struct Asked {
  const EffectSettings& effect;
  const EffectEntry& entry;
  const EffectParameter& parameter;
  const KeyChange& change;
};

std::vector<Asked> AskedBy(const Scenario& scenario) {
  std::vector<Asked> asked;
  for (const EffectSettings& effect : scenario.effects) {
    const EffectEntry* const entry = FindEffect(effect.name, scenario.bench);
    if (!entry) continue;  // a signal, which is in no catalogue
    for (const EffectParameter& parameter : entry->parameters) {
      for (const KeyChange& change : parameter.changes) {
        if (change.only_at.empty() || std::ranges::count(change.only_at, effect.where) > 0)
          asked.push_back({effect, *entry, parameter, change});
      }
    }
  }
  return asked;
}

}  // namespace

void ChangeKeys(Scenario& actual) {
  const std::vector<Asked> asked = AskedBy(actual);
  if (asked.empty()) return;  // a diagnosis follows the twin thousands of times: no list of all keys for nothing
  const std::vector<ScenarioKey> keys = KeysOf(actual);
  for (const auto& [effect, entry, parameter, change] : asked) {
    for (double& number : NumbersAt(keys, change.key, effect, entry))
      Change(change.how, change.share * Parameter(effect, parameter.name.c_str()), number);
  }
}

std::vector<EffectSettings> BeyondKeys(const Scenario& scenario) {
  std::vector<EffectSettings> effects = scenario.effects;
  std::erase_if(effects, [&](const EffectSettings& e) {
    const EffectEntry* const entry = FindEffect(e.name, scenario.bench);
    return entry && entry->ChangesKeysAlone();
  });
  return effects;
}

}  // namespace twinbench::sim
