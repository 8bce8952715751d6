#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "twin/core/bench_format.h"
#include "twin/core/errors.h"
#include "twin/core/nearest_key.h"
#include "twin/core/scenario_reader.h"
#include "twin/core/scenario_uncertainty.h"

namespace twinbench {
namespace {

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

}  // namespace

void RefuseUnknownKeys(const TomlSource& source, const std::vector<ScenarioKey>& keys, const std::string& bench) {
  KeyCheck(source, keys, bench).Check();
}

}  // namespace twinbench
