#include "twin/core/toml_reader.h"

#include <fmt/format.h>

#include <algorithm>

#include "twin/core/scenario_values.h"

namespace twinbench {
namespace {

/// Every key and, at the top, every table.
std::vector<KnownKey> KnownNames(const std::vector<ScenarioKey>& keys) {
  std::vector<KnownKey> known;
  for (const ScenarioKey& key : keys) {
    known.push_back({key.table, key.name, std::string(key.unit.suffix)});
    if (!key.table.empty()) known.push_back({"", key.table, ""});
  }
  return known;
}

class TableReader {
 public:
  TableReader(const TomlSource& source, const std::vector<ScenarioKey>& keys)
      : source_(source), keys_(keys), known_(KnownNames(keys)) {}

  KeyPlaces ReadAll() {
    for (const auto& [key, node] : source_.root) ReadTop(std::string(key.str()), TomlValue(node, source_));
    return places_;
  }

 private:
  void ReadTop(const std::string& name, const TomlValue& value) {
    const bool is_table = std::any_of(keys_.begin(), keys_.end(), [&](const auto& k) { return k.table == name; });
    if (name.empty() || !is_table) return ReadEntry("", name, value);
    if (!value.node().is_table())
      throw InputError(value.Where(), fmt::format("{} is {}", name, value.Found()),
                       fmt::format("a table [{}]", name));
    places_[name] = value.Where();
    for (const auto& [key, node] : *value.node().as_table())
      ReadEntry(name, std::string(key.str()), value.With(node));
  }

  void ReadEntry(const std::string& table, const std::string& name, const TomlValue& value) {
    const auto key = std::find_if(keys_.begin(), keys_.end(),
                                  [&](const ScenarioKey& k) { return k.table == table && k.Name() == name; });
    if (key == keys_.end()) throw UnknownKey(value.Where(), table, name, known_);
    ReadKey(*key, value);
    places_[key->Path()] = value.Where();
  }

  const TomlSource& source_;
  const std::vector<ScenarioKey>& keys_;
  std::vector<KnownKey> known_;
  KeyPlaces places_;
};

}  // namespace

KeyPlaces ReadToml(const std::string& text, const std::string& name, const std::vector<ScenarioKey>& keys) {
  const ScenarioText source(text, name, {});
  return TableReader(source.sources().front(), keys).ReadAll();
}

std::string TextAtTop(const std::string& text, const std::string& name, const std::string& key) {
  const ScenarioText source(text, name, {});
  return source.sources().front().root[key].value_or(std::string());
}

bool HasTable(const std::string& text, const std::string& name, const std::string& table) {
  const ScenarioText source(text, name, {});
  return source.sources().front().root[table].is_table();
}

}  // namespace twinbench
