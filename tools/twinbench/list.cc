#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "tools/twinbench/commands.h"
#include "tools/twinbench/json_answer.h"
#include "twin/core/bench_format.h"

namespace twinbench::tools {
namespace {

nlohmann::json EffectsOf(const BenchFormat& bench) {
  nlohmann::json effects = nlohmann::json::array();
  for (const EffectEntry& effect : bench.effects)
    effects.push_back({{"name", effect.name}, {"title", effect.title}, {"where", effect.places}});
  return effects;
}

nlohmann::json ListJson() {
  nlohmann::json benches = nlohmann::json::array();
  for (const BenchFormat* bench : BenchFormats())
    benches.push_back({{"name", bench->name}, {"title", bench->title}, {"effects", EffectsOf(*bench)}});
  return {{"benches", benches}};
}

void ListAll(JsonAnswer& answer) {
  answer.Write(ListJson());
  if (answer.IsOnStdout()) return;
  for (const BenchFormat* bench : BenchFormats()) {
    fmt::print("{}: {}\n", bench->name, bench->title);
    for (const EffectEntry& effect : bench->effects) fmt::print("    {:<24} {}\n", effect.name, effect.title);
  }
}

}  // namespace

void AddList(CLI::App& app) {
  auto* command = app.add_subcommand("list", "List the benches and the effects of each");
  AnswerWith(*command, "the list", ListAll);
}

}  // namespace twinbench::tools
