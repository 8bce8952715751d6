#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "tools/twinbench/commands.h"
#include "tools/twinbench/run_folder.h"
#include "twin/core/bench_format.h"

namespace twinbench::tools {
namespace {

nlohmann::json EffectsOf(const BenchFormat& bench) {
  nlohmann::json effects = nlohmann::json::array();
  for (const EffectEntry& effect : bench.effects)
    effects.push_back({{"name", effect.name}, {"title", effect.title}, {"where", effect.places}});
  return effects;
}

void ListAsJson() {
  nlohmann::json benches = nlohmann::json::array();
  for (const BenchFormat* bench : BenchFormats())
    benches.push_back({{"name", bench->name}, {"title", bench->title}, {"effects", EffectsOf(*bench)}});
  WriteJson("-", {{"benches", benches}});
}

void ListAll(bool as_json) {
  if (as_json) return ListAsJson();
  for (const BenchFormat* bench : BenchFormats()) {
    fmt::print("{}: {}\n", bench->name, bench->title);
    for (const EffectEntry& effect : bench->effects) fmt::print("    {:<24} {}\n", effect.name, effect.title);
  }
}

}  // namespace

void AddList(CLI::App& app) {
  auto* command = app.add_subcommand("list", "List the benches and what can be hidden in each");
  auto as_json = std::make_shared<bool>(false);
  command->add_flag("--json", *as_json, "for programs");
  command->callback([as_json] { ListAll(*as_json); });
}

}  // namespace twinbench::tools
