#include "tests/own_scenario/own_scenario.h"

#include <fmt/ranges.h>

#include <fstream>

#include "tests/hidden/judge.h"
#include "tests/support/angle_benches.h"
#include "tests/support/thresholds.h"
#include "twin/core/errors.h"
#include "twin/core/scenario_schema.h"

namespace twinbench::test {
namespace {

constexpr int kNullRuns = 100;  // enough for a threshold, and what a scan takes at once

/// A flag or a word may switch off what other keys say.
bool IsTriedAlone(const OwnKey& key) {
  const std::string value = key.settings.back().substr(key.settings.back().find('=') + 1);
  return value == "true" || value == "false" || value.starts_with('"');
}

std::string KeyOf(const std::string& setting) {
  return setting.substr(0, setting.find('='));
}

OwnRun RunTogether(const OwnBench& bench, const std::vector<OwnKey>& keys) {
  std::vector<std::string> stated, settings = bench.base;
  for (const OwnKey& key : keys) stated.insert(stated.end(), key.settings.begin(), key.settings.end());
  settings.insert(settings.end(), stated.begin(), stated.end());
  return {fmt::format("{}", fmt::join(stated, " ")), LoadScenario(ScenarioPath(bench.scenario), settings),
          static_cast<int>(keys.size())};
}

/// Neither says another value of a key than the others say, and the bench takes all of them.
bool Joins(const OwnKey& key, std::vector<OwnKey> group, const OwnBench& bench) {
  if (IsTriedAlone(key) || IsTriedAlone(group.front())) return false;
  for (const OwnKey& one : group) {
    for (const std::string& setting : one.settings) {
      const auto same = std::ranges::find(key.settings, KeyOf(setting), KeyOf);
      if (same != key.settings.end() && *same != setting) return false;
    }
  }
  group.push_back(key);
  try {
    RunTogether(bench, group);
  } catch (const InputError&) {
    return false;
  }
  return true;
}

/// Those that say nothing against each other are tried in one run.
std::vector<std::vector<OwnKey>> Grouped(const OwnBench& bench, std::size_t together) {
  std::vector<std::vector<OwnKey>> groups;
  for (const OwnKey& key : bench.keys) {
    if (key.settings.empty()) continue;
    const auto joined = std::ranges::find_if(groups, [&](const std::vector<OwnKey>& group) {
      return group.size() < together && Joins(key, group, bench);
    });
    (joined != groups.end() ? *joined : groups.emplace_back()).push_back(key);
  }
  return groups;
}

using Settings = std::vector<std::string>;

/// The text before and behind the first `mark`; nothing behind if there is none.
std::pair<std::string, std::string> SplitAt(const std::string& mark, const std::string& text) {
  const auto at = text.find(mark);
  if (at == std::string::npos) return {text, ""};
  return {text.substr(0, at), text.substr(at + mark.size())};
}

/// Keys of each bench from tests/data/own_scenario/BENCH.txt, in the order in which runs are made. A line is one of
///
///     machine.play_um=2 with A & B    a value that readings feel far above their noise, behind what must be so
///     machine.play_um=2 then A & B    the same in front of it
///     machine.title: words            the reason why no value can matter
///     $NAME: A & B                    settings that further lines have by this name
///     every run: A & B                what all runs have
///     every effect: A & B             what those with an effect have; without this line the same
///     each a, b                       the lines up to the next empty one, first with a for @ and then with b
class KeysFile {
 public:
  KeysFile(OwnBench& bench) : bench_(bench) {
    std::ifstream in(DataPath("own_scenario/" + bench.name + ".txt"));
    Require(in.is_open(), "every bench has a file of its keys");
    for (std::string line; std::getline(in, line);) {
      if (line.starts_with("each "))
        ReadBlock(hidden::Split(line.substr(5), ", "), in);
      else
        Read(line);
    }
    if (!named_.contains("every effect")) named_["every effect"] = named_["every run"];
    bench_.base = named_["every run"];
    bench_.effects_base = named_["every effect"];
  }

 private:
  void ReadBlock(const Settings& names, std::istream& in) {
    Settings lines;
    for (std::string line; std::getline(in, line) && !line.empty();) lines.push_back(line);
    for (const std::string& name : names) {
      for (const std::string& line : lines) {
        std::string of_name;
        for (const char c : line) of_name += c == '@' ? name : std::string(1, c);
        Read(of_name);
      }
    }
  }

  void Read(const std::string& line) {
    if (line.empty() || line[0] == '#') return;
    const auto [name, words] = SplitAt(": ", line);
    if (name[0] == '$' || name.starts_with("every "))
      named_[name] = Listed(words);
    else if (!words.empty())
      bench_.keys.push_back({name, {}, words});
    else
      ReadChange(line);
  }

  void ReadChange(const std::string& line) {
    const auto [head, then] = SplitAt(" then ", line);
    const auto [own, with] = SplitAt(" with ", head);
    OwnKey key{SplitAt("=", own).first, Listed(with)};
    key.settings.push_back(own);
    for (const std::string& setting : Listed(then)) key.settings.push_back(setting);
    bench_.keys.push_back(key);
  }

  Settings Listed(const std::string& text) const {
    Settings all;
    for (const std::string& part : hidden::Split(text, " & ")) {
      const Settings settings = part[0] == '$' ? named_.at(part) : Settings{part};
      all.insert(all.end(), settings.begin(), settings.end());
    }
    return all;
  }

  OwnBench& bench_;
  std::map<std::string, Settings> named_;
};

OwnBench WithKeys(OwnBench bench) {
  KeysFile{bench};
  return bench;
}

}  // namespace

std::vector<std::string> Forgotten(const std::string& bench, const std::vector<OwnKey>& keys) {
  std::set<std::string> in_schema, listed;
  Scenario scenario;
  scenario.bench = bench;
  for (const ScenarioKey& key : KeysOf(scenario)) in_schema.insert(key.Path());
  for (const OwnKey& key : keys) listed.insert(key.key);
  std::vector<std::string> forgotten;
  std::ranges::set_symmetric_difference(in_schema, listed, std::back_inserter(forgotten));
  return forgotten;
}

std::vector<OwnRun> KeyRuns(const OwnBench& bench, std::size_t together) {
  std::vector<OwnRun> runs;
  for (const std::vector<OwnKey>& group : Grouped(bench, together)) runs.push_back(RunTogether(bench, group));
  return runs;
}

std::vector<OwnRun> EffectRuns(const OwnBench& bench, std::size_t together) {
  const Scenario plain = LoadScenario(ScenarioPath(bench.scenario), bench.effects_base);
  std::vector<OwnRun> runs;
  for (const EffectEntry& entry : EffectCatalogue(plain.bench)) {
    if (entry.name == "outliers") continue;  // which readings they meet, nobody can foresee
    const bool joins = !runs.empty() && runs.back().scenario.effects.size() < together;
    if (!joins) runs.push_back({.scenario = plain, .stated = 0});
    OwnRun& run = runs.back();
    run.what += (joins ? " " : "") + entry.name;
    run.scenario.effects.push_back(PlainEffect(entry));
    ++run.stated;
  }
  return runs;
}

std::string AlarmIn(const std::vector<Reading>& readings, const Scenario& scenario) {
  return hidden::Says(readings, scenario, QuickOptions(kNullRuns));
}

std::string AlarmOf(const OwnRun& run) {
  return AlarmIn(ReadingsOf(run.scenario), run.scenario);
}

const std::vector<OwnBench>& OwnBenches() {
  static const std::vector<OwnBench> benches = {
      WithKeys({.name = kRotaryBench, .scenario = "rotary_4dof.toml"}),
      WithKeys({.name = kEncoderBench, .scenario = "encoder_comparison.toml"}),
      WithKeys({.name = kTurntableBench, .scenario = "turntable_autocollimator.toml", .effects_an_alarm = 50}),
      WithKeys({.name = kHobBench, .scenario = "hob_transmission.toml", .effects_an_alarm = 50}),
      WithKeys({.name = kCircularBench, .scenario = "circular_machining_centre.toml"}),
      WithKeys({.name = kFreeformBench, .scenario = "freeform_five_axis.toml"})};
  return benches;
}

}  // namespace twinbench::test
