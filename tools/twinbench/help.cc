#include <fmt/core.h>

#include "hw_bridge/machine_file.h"
#include "tools/twinbench/commands.h"
#include "twin/core/bench_format.h"
#include "twin/core/scenario.h"
#include "twin/core/signal_effect.h"
#include "twin/import/map.h"

namespace twinbench::tools {
namespace {

constexpr const char* kSeparator = ", ";

std::string Join(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : kSeparator) + word;
  return text;
}

void PrintParameters(const EffectEntry& effect) {
  for (const EffectParameter& p : effect.parameters)
    fmt::print("    {} = {:g}   {}\n", p.Key(), p.default_SI / p.to_SI, p.meaning);
}

/// Structure that no other effect has: a block says its point and its kind.
void PrintSignals(const BenchFormat& bench) {
  fmt::print("{}: structure that has no name: what enters at a point, times its course\n", kSignalEffect);
  fmt::print("    point = {}\n", Join(bench.points));
  for (const std::string& kind : SignalKinds()) {
    const std::vector<std::string> by = SignalArguments(kind, bench);
    fmt::print("  signal = \"{}\"{}\n", kind, by.empty() ? "" : "   by = " + Join(by));
    PrintParameters(SignalEntry(kind, "", bench));
  }
  fmt::print("  times = {}   what its size follows; all but direction with about_... and per_...\n",
             Join(SignalFactors()));
}

void PrintEffects(const BenchFormat& bench) {
  fmt::print("\nBench {}\n\n", bench.name);
  for (const EffectEntry& effect : bench.effects) {
    fmt::print("{}: {}\n", effect.name, effect.title);
    if (!effect.places.empty()) fmt::print("    where = {}\n", Join(effect.places));
    PrintParameters(effect);
  }
  PrintSignals(bench);
}

void PrintAllEffects() {
  fmt::print("An [[effect]] block hides one of these in the bench: name, where, and any of the parameters.\n");
  for (const BenchFormat* bench : BenchFormats()) PrintEffects(*bench);
}

void PrintBenchKeys() {
  fmt::print("bench.toml: which devices stand on the table and how they are reached (docs/hardware.md)\n\n");
  hw::BenchFile defaults;
  fmt::print("{}", DescribeKeys(hw::KeysOf(defaults)));
  hw::MachineFile machine;
  fmt::print(
      "\n# Of a bench whose machine is driven: a table for each axis and instrument, here for the axes x and "
      "a\n\n");
  fmt::print("{}", DescribeKeys(hw::KeysOf(machine, {{"x", false}, {"a", true}})));
}

void PrintDialogueKeys() {
  fmt::print("A dialogue says what is said to an instrument and what it answers (docs/hardware.md). Ready ones:\n\n");
  for (const hw::ReadyDialogue& ready : hw::ReadyDialogues())
    fmt::print("  {:<24} {}\n", ready.name, hw::ParseDialogue(ready.text, ready.name).title);
  hw::DialogueWords defaults;
  fmt::print("\nKeys of a dialogue:\n\n{}", DescribeKeys(defaults.Keys()));
}

void PrintHelp(const std::string& topic) {
  if (topic == "effects") return PrintAllEffects();
  if (topic == "bench") return PrintBenchKeys();
  if (topic == "dialogue") return PrintDialogueKeys();
  if (topic == "map") {
    fmt::print("{}", imports::DescribeMaps());
    return;
  }
  fmt::print("{}", DescribeScenarioKeys());
}

}  // namespace

void AddHelp(CLI::App& app) {
  auto* command = app.add_subcommand("help", "Explain the keys of scenarios, effects, bench files, dialogues or maps");
  auto topic = std::make_shared<std::string>("scenario");
  command->add_option("topic", *topic, "scenario, effects, bench, dialogue or map")
      ->check(CLI::IsMember({"scenario", "effects", "bench", "dialogue", "map"}));
  command->callback([topic] { PrintHelp(*topic); });
}

}  // namespace twinbench::tools
