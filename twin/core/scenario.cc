#include "twin/core/scenario.h"

#include <fmt/format.h>

#include <filesystem>

#include "twin/core/bench_format.h"
#include "twin/core/errors.h"
#include "twin/core/input_text.h"
#include "twin/core/nearest_key.h"
#include "twin/core/scenario_reader.h"
#include "twin/core/scenario_uncertainty.h"
#include "twin/core/scenario_values.h"
#include "twin/core/stream.h"

namespace twinbench {
namespace {

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

std::string ReadBench(const ScenarioText& text) {
  if (const auto bench = text.Find("bench")) return FormatOf(ReadText(*bench, "bench", {}), bench->Where()).name;
  throw InputError(text.name() + ":1", "bench is missing", "bench = " + Alternatives(BenchNames()));
}

}  // namespace

Scenario ParseScenario(const std::string& text, const std::string& name, const std::string& folder,
                       const std::vector<std::string>& overrides) {
  const ScenarioText sources(text, name, overrides);
  Scenario scenario;
  scenario.bench = ReadBench(sources);
  const std::vector<ScenarioKey> keys = KeysOf(scenario);
  for (const TomlSource& source : sources.sources()) RefuseUnknownKeys(source, keys, scenario.bench);
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
