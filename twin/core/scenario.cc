#include "twin/core/scenario.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <utility>

#include "twin/core/bench_format.h"
#include "twin/core/effect_catalogue.h"
#include "twin/core/errors.h"
#include "twin/core/input_text.h"
#include "twin/core/nearest_file.h"
#include "twin/core/nearest_key.h"
#include "twin/core/number_text.h"
#include "twin/core/reading.h"
#include "twin/core/scenario_schema.h"
#include "twin/core/scenario_text.h"
#include "twin/core/scenario_uncertainty.h"
#include "twin/core/scenario_values.h"
#include "twin/core/signal_effect.h"
#include "twin/core/stream.h"
#include "twin/core/table_errors.h"

namespace twinbench {
namespace {

constexpr const char* kEffectTable = "effect";
constexpr const char* kFixtureTable = "fixture";
constexpr const char* kEmpiricalTable = "empirical";

std::vector<std::string> KnownTables(const std::vector<ScenarioKey>& keys) {
  std::vector<std::string> tables;
  for (const ScenarioKey& key : keys) {
    if (std::find(tables.begin(), tables.end(), key.table) == tables.end()) tables.push_back(key.table);
  }
  return tables;
}

/// The bench that has the key or the table `path` where this one has not; empty if there is none.
std::string BenchThatHas(const std::string& path) {
  for (const BenchFormat* format : BenchFormats()) {
    Scenario scenario;
    scenario.bench = format->name;
    if (format->has_fixtures && path == kFixtureTable) return format->name;
    for (const ScenarioKey& key : KeysOf(scenario)) {
      if (key.Path() == path || key.table == path) return format->name;
    }
  }
  return "";
}

/// Refuses what is not in the description, in one source of the text.
class KeyCheck {
 public:
  KeyCheck(const TomlSource& source, const std::vector<ScenarioKey>& keys, const std::string& bench)
      : source_(source), bench_(bench), known_(KnownKeys(keys)), tables_(KnownTables(keys)) {
    for (const char* blocks : {kEffectTable, kEmpiricalTable}) known_.push_back({"", blocks, ""});
    if (FormatOf(bench).has_fixtures) known_.push_back({"", kFixtureTable, ""});
    for (const ScenarioKey& key : keys) {
      if (TakesUncertainty(key)) uncertainties_.insert(UncertaintyPath(key));
    }
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
    if (IsKey(path) || uncertainties_.contains(path)) return;
    if (IsTable(path)) {
      if (!value.node().is_table())
        throw InputError(value.Where(), fmt::format("{} is {}", path, value.Found()),
                         fmt::format("a table [{}]", path));
      CheckTable(*value.node().as_table(), path);
      return;
    }
    RefuseOtherBench(path, value);
    if (!value.node().is_table()) throw UnknownKey(value.Where(), table, key, known_);
    throw InputError(value.Where(), fmt::format("unknown table {}", path),
                     fmt::format("a known one; the nearest is {}", Nearest(path, {tables_.begin() + 1, tables_.end()})));
  }

  void RefuseOtherBench(const std::string& path, const TomlValue& value) const {
    const std::string other = BenchThatHas(path);
    if (!other.empty())
      throw InputError(value.Where(), fmt::format("{} belongs to the bench {}", path, other),
                       fmt::format("keys of {}", bench_));
  }

  const TomlSource& source_;
  std::string bench_;
  std::vector<KnownKey> known_;
  std::vector<std::string> tables_;  // the first is the top, ""
  std::set<std::string> uncertainties_;
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

// --- [[empirical]] ---

/// Key of the values in a file.
std::string ValueKey(SignalKind kind) {
  if (kind == SignalKind::kOwn) return "value";
  return kind == SignalKind::kAngle ? "value_deg" : "value_um";
}

void RequireEmpirical(EmpiricalSettings empirical, const BenchFormat& bench) {
  const auto require = [&](bool condition, const std::string& what, const std::string& expected) {
    if (!condition) throw InputError(empirical.location, what, expected);
  };
  require(std::ranges::count(bench.channels, empirical.channel) > 0,
          fmt::format("the empirical signal is for the channel \"{}\"", empirical.channel),
          "a channel of the bench " + bench.name);
  const std::vector<double> values = std::exchange(ValuesOf(empirical, bench.signal), {});
  const std::string key = ValueKey(bench.signal);
  require(empirical.value_m.empty() && empirical.value_rad.empty() && empirical.value.empty(),
          "the empirical signal has values of another kind of channel", key);
  const bool by_time = empirical.by == "time";
  const std::size_t places = by_time ? empirical.time_s.size() : empirical.reading.size();
  require(!values.empty() && values.size() == places,
          fmt::format("the empirical signal has {} {}s and {} values", places, empirical.by, values.size()),
          fmt::format("one {} for each {}", key, empirical.by));
  if (by_time) {
    require(empirical.reading.empty(), "the empirical signal by time names readings", "time_s alone");
    require(std::ranges::is_sorted(empirical.time_s, std::less_equal()),
            "the times of the empirical signal do not ascend", "each time later than the one before");
    return;
  }
  const std::set<int> once(empirical.reading.begin(), empirical.reading.end());
  require(once.size() == values.size(), "the empirical signal names a reading twice", "every reading once");
  require(empirical.time_s.empty() || empirical.time_s.size() == places,
          fmt::format("the empirical signal has {} readings and {} times", places, empirical.time_s.size()),
          "one time_s for each reading, or none");
}

EmpiricalSettings ReadEmpirical(const TomlValue& block, const std::string& bench) {
  EmpiricalSettings empirical;
  empirical.location = block.Where();
  const std::vector<ScenarioKey> keys = KeysOf(empirical);
  RefuseUnknown(block, kEmpiricalTable, KnownKeys(keys));
  for (const ScenarioKey& key : keys) {
    if (const auto value = Inside(block, key.Name())) ReadKey(key, *value);
  }
  RequireEmpirical(empirical, FormatOf(bench));
  return empirical;
}

std::string ReadBench(const ScenarioText& text) {
  if (const auto bench = text.Find("bench")) return FormatOf(ReadText(*bench, "bench", {}), bench->Where()).name;
  throw InputError(text.name() + ":1", "bench is missing", "bench = " + Alternatives(BenchNames()));
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
                   OrNearestFile("a readable file, named from the scenario's folder", path));
}

/// Moves the content of the file that `content`_file names to `content`. Where both are given the later source
/// counts.
/// @param content  "target.errors"
template <class Content>
void LoadContent(const ScenarioText& text, const std::string& content, const std::string& folder, std::string& name,
                 Content (*read)(const std::string&), std::optional<Content>& place) {
  if (name.empty()) return;
  const std::string key = content + "_file";
  const auto block = text.Find(content);
  const auto file = text.Find(key);
  if (block && &block->source() == &file->source())
    throw InputError(file->Where(), fmt::format("{} is given beside a table {}", key, content), "one of them");
  const bool file_is_later = !block || &file->source() > &block->source();
  if (file_is_later) place = read(NamedFile(file->Where(), key, folder, name));
  name.clear();
}

/// Where the text of a key is.
std::string& FileNameAt(const std::vector<ScenarioKey>& keys, const std::string& path) {
  const auto key = std::ranges::find(keys, path, &ScenarioKey::Path);
  Require(key != keys.end(), "content of a table has no file that could name it");
  return *std::get<std::string*>(key->field);
}

void LoadFiles(const ScenarioText& text, const std::string& folder, const std::vector<ScenarioKey>& keys) {
  for (const ScenarioKey& key : keys) {
    if (key.names_a_file) {
      std::string& file = *std::get<std::string*>(key.field);
      if (!file.empty()) file = NamedFile(text.Where(key.Path(), text.name() + ":1"), key.Path(), folder, file);
    }
    if (auto* const* errors = std::get_if<std::optional<TableErrors>*>(&key.field))
      LoadContent(text, key.Path(), folder, FileNameAt(keys, key.Path() + "_file"), ReadTableErrors, **errors);
    if (auto* const* compensation = std::get_if<std::optional<CompensationTable>*>(&key.field))
      LoadContent(text, key.Path(), folder, FileNameAt(keys, key.Path() + "_file"), ReadCompensationTable,
                  **compensation);
  }
}

void LoadMeshes(const std::string& folder, std::vector<FixtureSettings>& fixtures) {
  for (FixtureSettings& f : fixtures) {
    if (!f.mesh_file.empty()) f.mesh_file = NamedFile(f.location, "fixture.mesh_file", folder, f.mesh_file);
  }
}

}  // namespace

Scenario ParseScenario(const std::string& text, const std::string& name, const std::string& folder,
                       const std::vector<std::string>& overrides) {
  const ScenarioText sources(text, name, overrides);
  Scenario scenario;
  scenario.bench = ReadBench(sources);
  const std::vector<ScenarioKey> keys = KeysOf(scenario);
  for (const TomlSource& source : sources.sources()) KeyCheck(source, keys, scenario.bench).Check();
  for (const ScenarioKey& key : keys) {
    if (const auto value = sources.Find(key.Path())) ReadKey(key, *value);
  }
  scenario.uncertainties = ReadUncertainties(sources, keys);
  scenario.fixtures = ReadBlocks<FixtureSettings>(sources, kFixtureTable, ReadFixture);
  scenario.effects = ReadBlocks<EffectSettings>(
      sources, kEffectTable, [&](const TomlValue& block) { return ReadEffect(block, scenario.bench); });
  scenario.empiricals = ReadBlocks<EmpiricalSettings>(
      sources, kEmpiricalTable, [&](const TomlValue& block) { return ReadEmpirical(block, scenario.bench); });
  if (const auto check = FormatOf(scenario.bench).check_together) check(sources, scenario);
  LoadFiles(sources, folder, keys);
  LoadMeshes(folder, scenario.fixtures);
  return scenario;
}

Scenario LoadScenario(const std::string& path, const std::vector<std::string>& overrides) {
  return ParseScenario(InputText(path, "a scenario in TOML"), path, std::filesystem::path(path).parent_path().string(), overrides);
}

std::string BenchOfScenarioFile(const std::string& path) {
  return ReadBench(ScenarioText(InputText(path, "a scenario in TOML"), path, {}));
}

std::uint64_t Scenario::RunSeed() const {
  if (repeat == 0) return seed;
  Stream runs(seed, "repeat");
  runs.Seek(static_cast<std::uint64_t>(repeat));
  const std::uint64_t high = runs.Word();
  return high << 32 | runs.Word();
}

Scenario Altered(const Scenario& scenario, const std::vector<std::string>& sets) {
  return ParseScenario(WriteScenario(scenario), "the scenario", "", sets);
}

}  // namespace twinbench
