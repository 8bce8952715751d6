#include <fstream>
#include <map>

#include "tests/own_scenario/own_scenario.h"
#include "tests/support/twin_run.h"
#include "twin/benches/names.h"
#include "twin/core/errors.h"

/// Keys of each bench from tests/data/own_scenario/BENCH.txt, in the order in which runs are made. A line is one of
///
///     machine.play_um=2 with A & B    a value that readings feel far above their noise, behind what must be so
///     machine.play_um=2 then A & B    the same in front of it
///     machine.title: words            the reason why no value can matter
///     $NAME: A & B                    settings that further lines have by this name
///     every run: A & B                what all runs have
///     every effect: A & B             what those with an effect have; without this line the same
///     each a, b                       the lines up to the next empty one, first with a for @ and then with b
namespace twinbench::test {
namespace {

using Settings = std::vector<std::string>;

/// The text before and behind the first `mark`; nothing behind if there is none.
std::pair<std::string, std::string> SplitAt(const std::string& mark, const std::string& text) {
  const auto at = text.find(mark);
  if (at == std::string::npos) return {text, ""};
  return {text.substr(0, at), text.substr(at + mark.size())};
}

Settings PartsOf(std::string text, const std::string& mark) {
  Settings parts;
  while (!text.empty()) {
    const auto [part, rest] = SplitAt(mark, text);
    parts.push_back(part);
    text = rest;
  }
  return parts;
}

class KeysFile {
 public:
  KeysFile(OwnBench& bench) : bench_(bench) {
    std::ifstream in(DataPath("own_scenario/" + bench.name + ".txt"));
    Require(in.is_open(), "every bench has a file of its keys");
    for (std::string line; std::getline(in, line);) {
      if (line.starts_with("each "))
        ReadBlock(PartsOf(line.substr(5), ", "), in);
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
    for (const std::string& part : PartsOf(text, " & ")) {
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
