#include <fmt/core.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "hw_bridge/machine_file.h"
#include "tools/twinbench/commands.h"
#include "tools/twinbench/json_answer.h"
#include "twin/core/bench_format.h"
#include "twin/core/errors.h"
#include "twin/core/nearest_key.h"
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

std::string ParametersText(const EffectEntry& effect) {
  std::string text;
  for (const EffectParameter& p : effect.parameters)
    text += fmt::format("    {} = {:g}   {}\n", p.Key(), p.default_SI / p.to_SI, p.meaning);
  return text;
}

/// Structure that no other effect has: a block says its point and its kind.
std::string SignalsText(const BenchFormat& bench) {
  std::string text = fmt::format("{}: an unmodelled effect: what enters at a point, times a time function\n", kSignalEffect);
  text += fmt::format("    point = {}\n", Join(bench.points));
  for (const std::string& kind : SignalKinds()) {
    const std::vector<std::string> by = SignalArguments(kind, bench);
    text += fmt::format("  signal = \"{}\"{}\n", kind, by.empty() ? "" : "   by = " + Join(by));
    text += ParametersText(SignalEntry(kind, "", bench));
  }
  return text + fmt::format("  times = {}   what its size follows; all but direction with about_... and per_...\n",
                            Join(SignalFactors()));
}

std::string EffectsText(const BenchFormat& bench) {
  std::string text = fmt::format("\nBench {}\n\n", bench.name);
  for (const EffectEntry& effect : bench.effects) {
    text += fmt::format("{}: {}\n", effect.name, effect.title);
    if (!effect.places.empty()) text += fmt::format("    where = {}\n", Join(effect.places));
    text += ParametersText(effect);
  }
  return text + SignalsText(bench);
}

std::string AllEffectsText() {
  std::string text = "An [[effect]] block hides one of these in the bench: name, where, and any of the parameters.\n";
  for (const BenchFormat* bench : BenchFormats()) text += EffectsText(*bench);
  return text;
}

std::string BenchKeysText() {
  hw::BenchFile defaults;
  hw::MachineFile machine;
  return "bench.toml: which devices stand on the table and how they are reached (docs/hardware.md)\n\n" + DescribeKeys(hw::KeysOf(defaults)) +
         "\n# Of a bench whose machine is driven: a table for each axis and instrument, here for the axes x and a\n\n" +
         DescribeKeys(hw::KeysOf(machine, {{"x", false}, {"a", true}}));
}

std::string DialogueKeysText() {
  std::string text = "A dialogue says what is said to an instrument and what it answers (docs/hardware.md). Ready ones:\n\n";
  for (const hw::ReadyDialogue& ready : hw::ReadyDialogues())
    text += fmt::format("  {:<24} {}\n", ready.name, hw::ParseDialogue(ready.text, ready.name).title);
  hw::DialogueWords defaults;
  return text + "\nKeys of a dialogue:\n\n" + DescribeKeys(defaults.Keys());
}

/// What a block "[target.random]" or "[[fixture]]" is of; empty of a line that begins none.
std::string TableOf(const std::string& line) {
  const std::size_t first = line.find_first_not_of('['), end = line.find(']');
  return line.starts_with("[") && end != line.npos ? line.substr(first, end - first) : "";
}

/// Of the scenario's keys those of a bench, or those of a table of any bench.
std::string KeysUnder(const std::string& wanted) {
  std::istringstream text(DescribeScenarioKeys() + "\n# ---- bench ----\n");
  std::string found, bench, table;
  std::vector<std::string> known;
  for (std::string line; std::getline(text, line);) {
    const bool begins = line.starts_with("# ---- bench ");
    if (begins) bench = line, table.clear();
    if (const std::string name = TableOf(line); !name.empty()) table = name, known.push_back(name.substr(0, name.find('.')));
    if (begins) known.push_back(line.substr(13, line.find(' ', 13) - 13));
    const bool is_bench = bench == "# ---- bench " + wanted + " ----";
    if (!is_bench && table != wanted && !table.starts_with(wanted + ".")) continue;
    if (!is_bench && line.starts_with("[" + wanted + "]")) found += bench + "\n";
    found += line + "\n";
  }
  if (found.empty()) throw InputError("help scenario " + wanted, "there is no such bench or table", "a known one; the nearest is " + Nearest(wanted, known));
  return found;
}

std::string HelpText(const std::string& topic, const std::string& of) {
  if (!of.empty() && topic != "scenario") throw InputError("help " + topic + " " + of, "only help scenario takes a second word", "help " + topic);
  if (!of.empty()) return KeysUnder(of);
  if (topic == "effects") return AllEffectsText();
  if (topic == "bench") return BenchKeysText();
  if (topic == "dialogue") return DialogueKeysText();
  return topic == "map" ? imports::DescribeMaps() : DescribeScenarioKeys();
}

void Help(const std::string& topic, const std::string& of, JsonAnswer& answer) {
  const std::string text = HelpText(topic, of);
  if (!answer.IsOnStdout()) fmt::print("{}", text);
  answer.Write({{"topic", topic}, {"text", text}});
}

}  // namespace

void AddHelp(CLI::App& app) {
  auto* command = app.add_subcommand("help", "Explain the keys of scenarios, effects, bench files, dialogues or maps");
  auto topic = std::make_shared<std::string>("scenario");
  command->add_option("topic", *topic, "scenario, effects, bench, dialogue or map")
      ->check(OneOf({"scenario", "effects", "bench", "dialogue", "map"}));
  auto of = std::make_shared<std::string>();
  command->add_option("of", *of, "with scenario: a bench or a table, as rotary_4dof or laser; left out: all");
  AnswerWith(*command, "the same", [topic, of](JsonAnswer& answer) { Help(*topic, *of, answer); });
}

}  // namespace twinbench::tools
