#include "twin/core/scenario.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "twin/core/effect_catalogue.h"
#include "twin/core/errors.h"
#include "twin/core/nearest_key.h"
#include "twin/core/number_text.h"
#include "twin/core/reading.h"
#include "twin/core/scenario_schema.h"
#include "twin/core/scenario_text.h"
#include "twin/core/scenario_values.h"

namespace twinbench {
namespace {

constexpr const char* kEffectTable = "effect";
constexpr const char* kFixtureTable = "fixture";

std::vector<KnownKey> KnownKeys(const std::vector<ScenarioKey>& keys) {
  std::vector<KnownKey> known;
  for (const ScenarioKey& key : keys) known.push_back({key.table, key.name, std::string(key.unit.suffix)});
  return known;
}

std::vector<std::string> KnownTables(const std::vector<ScenarioKey>& keys) {
  std::vector<std::string> tables;
  for (const ScenarioKey& key : keys) {
    if (std::find(tables.begin(), tables.end(), key.table) == tables.end()) tables.push_back(key.table);
  }
  return tables;
}

/// Refuses what is not in the description, in one source of the text.
class KeyCheck {
 public:
  KeyCheck(const TomlSource& source, const std::vector<ScenarioKey>& keys)
      : source_(source), known_(KnownKeys(keys)), tables_(KnownTables(keys)) {
    for (const char* blocks : {kFixtureTable, kEffectTable}) known_.push_back({"", blocks, ""});
  }

  void Check() const { CheckTable(source_.root, ""); }

 private:
  bool IsKey(const std::string& path) const {
    return std::any_of(known_.begin(), known_.end(), [&](const KnownKey& key) { return key.Path() == path; });
  }
  bool IsTable(const std::string& path) const {
    return std::find(tables_.begin(), tables_.end(), path) != tables_.end();
  }

  void CheckTable(const toml::table& table, const std::string& path) const {
    for (const auto& [key, node] : table) CheckEntry(path, std::string(key.str()), TomlValue(node, source_));
  }

  void CheckEntry(const std::string& table, const std::string& key, const TomlValue& value) const {
    const std::string path = table.empty() ? key : table + "." + key;
    const bool quoted_oddly = key.empty() || key.find('.') != std::string::npos;
    if (quoted_oddly) throw UnknownKey(value.Where(), table, key, known_);
    if (IsKey(path)) return;
    if (IsTable(path)) {
      if (!value.node().is_table())
        throw InputError(value.Where(), fmt::format("{} is {}", path, value.Found()),
                         fmt::format("a table [{}]", path));
      CheckTable(*value.node().as_table(), path);
      return;
    }
    if (!value.node().is_table()) throw UnknownKey(value.Where(), table, key, known_);
    throw InputError(value.Where(), fmt::format("unknown table {}", path),
                     fmt::format("a known one; the nearest is {}", Nearest(path, tables_)));
  }

  const TomlSource& source_;
  std::vector<KnownKey> known_;
  std::vector<std::string> tables_;  // the first is the top, ""
};

/// Reads every [[table]] block of the text with `read(block)`.
template <class Block, class Read>
std::vector<Block> ReadBlocks(const ScenarioText& text, const std::string& table, Read read) {
  const auto value = text.Find(table);
  if (!value) return {};
  const auto refuse = [&](const TomlValue& found) {
    throw InputError(found.Where(), fmt::format("{} is {}", table, found.Found()),
                     fmt::format("[[{}]] blocks", table));
  };
  if (!value->node().is_array()) refuse(*value);
  std::vector<Block> blocks;
  for (const toml::node& node : *value->node().as_array()) {
    if (!node.is_table()) refuse(value->With(node));
    blocks.push_back(read(value->With(node)));
  }
  return blocks;
}

// --- [[fixture]] ---

FixtureSettings ReadFixture(const TomlValue& block) {
  FixtureSettings fixture;
  fixture.location = block.Where();
  const std::vector<ScenarioKey> keys = KeysOf(fixture);
  RefuseUnknown(block, kFixtureTable, KnownKeys(keys));
  for (const ScenarioKey& key : keys) {
    if (const auto value = Inside(block, key.Name())) ReadKey(key, *value);
  }
  if (fixture.name.empty()) throw InputError(block.Where(), "the fixture has no name", "name = \"housing\"");
  if (std::isnan(fixture.box_m.x()) == fixture.mesh_file.empty())
    throw InputError(
        block.Where(),
        fmt::format("the fixture {} has {} box_mm {} mesh_file", fixture.name,
                    fixture.mesh_file.empty() ? "neither" : "both", fixture.mesh_file.empty() ? "nor" : "and"),
        "one of them");
  return fixture;
}

// --- [[effect]] ---

std::vector<std::string> EffectNames() {
  std::vector<std::string> names;
  for (const EffectEntry& entry : EffectCatalogue()) names.push_back(entry.name);
  return names;
}

/// "name, where ("psd_a" or "psd_b"), roll_mrad": what a block of this effect may have.
std::string EffectForm(const EffectEntry& entry) {
  std::string form = "name";
  if (!entry.places.empty()) form += fmt::format(", where ({})", Alternatives(entry.places));
  for (const EffectParameter& parameter : entry.parameters) form += ", " + parameter.Key();
  return form;
}

const EffectEntry& EntryOf(const TomlValue& block, const toml::table& table) {
  const toml::node* node = table.get("name");
  if (!node) throw InputError(block.Where(), "the effect has no name", Alternatives(EffectNames()));
  const TomlValue value = block.With(*node);
  const std::string name = ReadText(value, "effect.name", {});
  if (const EffectEntry* entry = FindEffect(name)) return *entry;
  throw InputError(value.Where(), fmt::format("unknown effect \"{}\"", name),
                   fmt::format("a known one; the nearest is \"{}\"", Nearest(name, EffectNames())));
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

void CheckEffectKeys(const TomlValue& block, const toml::table& table, const EffectEntry& entry,
                     const std::string& place) {
  for (const auto& [key, node] : table) {
    const std::string name(key.str());
    const auto parameter = std::find_if(entry.parameters.begin(), entry.parameters.end(),
                                        [&](const EffectParameter& p) { return p.Key() == name; });
    const bool known = parameter != entry.parameters.end();
    if (name == "name" || name == "where" || (known && parameter->BelongsTo(place))) continue;
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

EffectSettings ReadEffect(const TomlValue& block) {
  const toml::table& table = *block.node().as_table();
  const EffectEntry& entry = EntryOf(block, table);
  EffectSettings effect;
  effect.name = entry.name;
  effect.where = ReadPlace(block, table, entry);
  effect.location = block.Where();
  CheckEffectKeys(block, table, entry, effect.where);
  for (const EffectParameter& parameter : entry.parameters)
    effect.parameters[parameter.name] = ReadParameter(block, table, parameter, entry.name);
  return effect;
}

// --- what keys say together ---

void CheckBench(const ScenarioText& text) {
  if (!text.Find("bench"))
    throw InputError(text.name() + ":1", "bench is missing", "bench = " + Alternatives(SupportedBenches()));
}

void CheckScanList(const ScenarioText& text, const AdcSettings& adc) {
  const std::set<std::string> once(adc.scan_list.begin(), adc.scan_list.end());
  if (once.size() == kChannelNames.size() && adc.scan_list.size() == kChannelNames.size()) return;
  throw InputError(text.Where("adc.scan_list", text.name() + ":1"),
                   fmt::format("adc.scan_list names {} of the {} channels in {} entries", once.size(),
                               kChannelNames.size(), adc.scan_list.size()),
                   "every channel once");
}

void CheckShifts(const ScenarioText& text, const ProcedureSettings& procedure) {
  const std::string where = text.Where("procedure.shifts", text.Where("procedure.positions", text.name() + ":1"));
  const std::vector<int>& shifts = procedure.shifts;
  for (const int shift : shifts) {
    if (shift >= procedure.positions)
      throw InputError(where, fmt::format("procedure.shifts has {}", shift),
                       fmt::format("shifts from 0 to {} (positions - 1)", procedure.positions - 1));
    if (std::count(shifts.begin(), shifts.end(), shift) > 1)
      throw InputError(where, fmt::format("procedure.shifts has {} twice", shift), "every shift once");
  }
}

void CheckPasses(const ScenarioText& text, const ProcedureSettings& procedure) {
  for (const int direction : procedure.passes) {
    if (direction == 0)
      throw InputError(text.Where("procedure.passes", text.name() + ":1"), "procedure.passes has 0",
                       "directions 1 or -1");
  }
}

void CheckProfile(const ScenarioText& text, const LaserSettings& laser) {
  if (laser.beam == BeamModel::kProfile && laser.profile_file.empty())
    throw InputError(text.Where("laser.beam", text.name() + ":1"), "laser.beam is \"profile\" without a file",
                     "laser.profile_file = \"beam.exr\"");
}

// --- files that a scenario names ---

std::string AbsolutePath(const std::string& folder, const std::string& file) {
  return std::filesystem::absolute(std::filesystem::path(folder) / file).lexically_normal().string();
}

/// @return the absolute path of the file that `key` names.
/// @param where  The key stands there.
std::string NamedFile(const std::string& where, const std::string& key, const std::string& folder,
                      const std::string& file) {
  const std::string path = AbsolutePath(folder, file);
  if (std::filesystem::is_regular_file(path) && std::ifstream(path)) return path;
  throw InputError(where, fmt::format("{}: the file {} cannot be read", key, path),
                   "a readable file, named from the scenario's folder");
}

void FindFile(const ScenarioText& text, const std::string& key, const std::string& folder, std::string& file) {
  if (!file.empty()) file = NamedFile(text.Where(key, text.name() + ":1"), key, folder, file);
}

/// Moves the content of errors_file to `errors`. Where both are given the later source counts.
void LoadErrors(const ScenarioText& text, const std::string& table, const std::string& folder, TableSettings& s) {
  if (s.errors_file.empty()) return;
  const std::string key = table + ".errors_file";
  const auto block = text.Find(table + ".errors");
  const auto file = text.Find(key);
  if (block && &block->source() == &file->source())
    throw InputError(file->Where(), fmt::format("{} is given beside a table {}.errors", key, table), "one of them");
  const bool file_is_later = !block || &file->source() > &block->source();
  if (file_is_later) s.errors = ReadTableErrors(NamedFile(file->Where(), key, folder, s.errors_file));
  s.errors_file.clear();
}

void LoadFiles(const ScenarioText& text, const std::string& folder, Scenario& scenario) {
  FindFile(text, "laser.profile_file", folder, scenario.laser.profile_file);
  FindFile(text, "grating.efficiency_file", folder, scenario.grating.efficiency_file);
  FindFile(text, "environment.temperature_file", folder, scenario.environment.temperature_file);
  LoadErrors(text, "target", folder, scenario.target);
  LoadErrors(text, "reference", folder, scenario.reference);
  for (FixtureSettings& f : scenario.fixtures) {
    if (!f.mesh_file.empty()) f.mesh_file = NamedFile(f.location, "fixture.mesh_file", folder, f.mesh_file);
  }
}

}  // namespace

Scenario ParseScenario(const std::string& text, const std::string& name, const std::string& folder,
                       const std::vector<std::string>& overrides) {
  const ScenarioText sources(text, name, overrides);
  Scenario scenario;
  const std::vector<ScenarioKey> keys = KeysOf(scenario);
  CheckBench(sources);
  for (const TomlSource& source : sources.sources()) KeyCheck(source, keys).Check();
  for (const ScenarioKey& key : keys) {
    if (const auto value = sources.Find(key.Path())) ReadKey(key, *value);
  }
  scenario.fixtures = ReadBlocks<FixtureSettings>(sources, kFixtureTable, ReadFixture);
  scenario.effects = ReadBlocks<EffectSettings>(sources, kEffectTable, ReadEffect);
  CheckScanList(sources, scenario.adc);
  CheckShifts(sources, scenario.procedure);
  CheckPasses(sources, scenario.procedure);
  CheckProfile(sources, scenario.laser);
  LoadFiles(sources, folder, scenario);
  return scenario;
}

Scenario LoadScenario(const std::string& path, const std::vector<std::string>& overrides) {
  std::ifstream in(path);
  std::ostringstream text;
  if (!in || !(text << in.rdbuf()))
    throw InputError(path, "the file cannot be read or is empty", "a scenario in TOML");
  return ParseScenario(text.str(), path, std::filesystem::path(path).parent_path().string(), overrides);
}

}  // namespace twinbench
