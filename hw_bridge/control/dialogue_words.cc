#include "hw_bridge/control/dialogue_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>

#include "twin/core/errors.h"
#include "twin/core/input_text.h"
#include "twin/core/nearest_key.h"
#include "twin/core/toml_reader.h"
#include "twin/core/units.h"

namespace twinbench::hw {
namespace {

struct DialogueUnit {
  const char* name;
  char kind;  // units of one kind are told in each other
  double to_SI;
};

// clang-format off
constexpr std::array kDialogueUnits = std::to_array<DialogueUnit>({
    {"deg", 'a', units::deg}, {"arcmin", 'a', units::deg / 60.0}, {"arcsec", 'a', units::arcsec},
    {"rad", 'a', 1.0}, {"mrad", 'a', units::mrad}, {"urad", 'a', units::urad}, {"turn", 'a', units::turn},
    {"m", 'l', 1.0}, {"mm", 'l', units::mm}, {"um", 'l', units::um}, {"nm", 'l', units::nm}, {"inch", 'l', 0.0254},
    {"degC", 't', 1.0}, {"V", 'v', 1.0}, {"mV", 'v', 1e-3},
    {"s", 's', 1.0}, {"ms", 's', 1e-3}, {"us", 's', 1e-6}, {"ns", 's', 1e-9},
});
// clang-format on

const DialogueUnit* UnitWith(const std::string& name) {
  const auto* found =
      std::ranges::find_if(kDialogueUnits, [&](const DialogueUnit& unit) { return name == unit.name; });
  return found == kDialogueUnits.end() ? nullptr : found;
}

const DialogueUnit& UnitAt(const std::string& name, const std::string& where) {
  if (const DialogueUnit* unit = UnitWith(name)) return *unit;
  std::vector<std::string> known;
  for (const DialogueUnit& unit : kDialogueUnits) known.emplace_back(unit.name);
  throw InputError(where, fmt::format("\"{}\" is no unit", name), fmt::format("\"{}\"", Nearest(name, known)));
}

ScenarioKey TextKey(const char* table, const char* name, Field field, const char* meaning,
                    std::vector<std::string> choices = {}) {
  return {table, name, {}, {}, std::move(choices), field, meaning};
}

/// What keys say together.
class DialogueCheck {
 public:
  DialogueCheck(const DialogueWords& words, const KeyPlaces& places, std::string file)
      : words_(words), places_(places), file_(std::move(file)) {}

  void Check() const {
    CheckRead();
    if (words_.line.separator.empty())
      throw InputError(Where("line.separator"), "line.separator is empty", "what stands between two fields");
    if (words_.read.ask.empty() && words_.move.empty() && words_.tilt.empty())
      throw InputError(file_ + ":1", "the dialogue says nothing that can be asked of the device",
                       "ask of [read], or command of [move] or [tilt]");
    CheckPlaces("latch.arm", words_.arm, {"{samples}", "{lines}"});
    CheckPlaces("move.command", words_.move, {"{tooth}", "{deg}"});
    CheckPlaces("tilt.command", words_.tilt, {"{yaw}", "{tilt}"});
    UnitToSI(words_.tilt_unit, Where("tilt.unit"));
    if (words_.arm.empty() != words_.fetch.empty())
      throw InputError(Where("latch"), "[latch] has only one of arm and fetch", "both, or neither");
  }

 private:
  std::string Where(const std::string& key) const {
    if (const auto found = places_.find(key); found != places_.end()) return found->second;
    const auto table = places_.find(key.substr(0, key.find('.')));
    return table != places_.end() ? table->second : file_ + ":1";
  }

  void CheckRead() const {
    const ReadWords& read = words_.read;
    if (read.ask.empty() != read.fields.empty())
      throw InputError(Where("read"), "[read] has only one of ask and fields",
                       "the query, and the fields of its answer");
    CheckCount("read.units", read.units.size());
    CheckCount("read.scale", read.scale.size());
    CheckCount("read.valid", read.valid.size());
    for (const std::string& unit : read.units) UnitToSI(unit, Where("read.units"));
  }

  void CheckCount(const std::string& key, std::size_t entries) const {
    if (entries == 0 || entries == words_.read.fields.size()) return;
    throw InputError(Where(key),
                     fmt::format("{} has {} entries for {} fields", key, entries, words_.read.fields.size()),
                     "one a field");
  }

  /// What stands in braces is filled in; a misspelt place would be said to the device.
  void CheckPlaces(const std::string& key, const std::string& command,
                   const std::vector<std::string>& known) const {
    for (auto at = command.find('{'); at != std::string::npos; at = command.find('{', at + 1)) {
      const std::string place = command.substr(at, command.find('}', at) - at + 1);
      if (std::ranges::find(known, place) == known.end())
        throw InputError(Where(key), fmt::format("there is no place {} in {}", place, key), Nearest(place, known));
    }
  }

  const DialogueWords& words_;
  const KeyPlaces& places_;
  std::string file_;
};

std::string NamesOfReady() {
  std::string names;
  for (const ReadyDialogue& ready : ReadyDialogues()) names += (names.empty() ? "" : ", ") + ready.name;
  return names;
}

}  // namespace

std::vector<ScenarioKey> DialogueWords::Keys() {
  const std::vector<std::string> ends = {"LF", "CR", "CRLF"};
  return {
      TextKey("", "title", &title, "what it is"),
      TextKey("", "identify", &identify, "query that tells who it is; empty: it does not"),
      TextKey("line", "ends", &line.ends, "of a line that is sent", ends),
      TextKey("line", "answer_ends", &line.answer_ends, "of a line that comes; a CR before an LF counts to it",
              {"LF", "CR", "CRLF", kAnyLineEnd}),
      TextKey("line", "answer_begins", &line.answer_begins, "what every answer begins with; taken off"),
      TextKey("line", "separator", &line.separator, "between the fields of an answer; blanks count once"),
      TextKey("errors", "ask", &errors.ask, "query behind a command; empty: there is none"),
      TextKey("errors", "none", &errors.none, "what its answer begins with where all is well"),
      TextKey("errors", "limit", &errors.limit, "... where the command would go beyond a limit"),
      TextKey("errors", "acknowledged", &errors.acknowledged,
              "a command is answered by a line that begins so; empty: by none"),
      TextKey("errors", "refusals", &errors.refusals, "an answer that begins so is a refusal"),
      TextKey("read", "ask", &read.ask, "query that is answered by one sample"),
      TextKey("read", "look", &read.look, "the same on the way to a reading; empty: as ask"),
      TextKey("read", "fields", &read.fields, "x, y, temperature, a column, time_ns, status, ignored; in order"),
      TextKey("read", "units", &read.units, "one a field; empty: a pure number or the column's own"),
      {"read", "scale", {}, {}, {}, &read.scale, "one a field; the number times this is in its unit"},
      TextKey("read", "valid", &read.valid, "what a field must be, else nothing is shown; empty: anything"),
      TextKey("read", "nothing", &read.nothing, "texts in a number's place that mean that there is none"),
      TextKey("latch", "arm", &arm, "lets it latch {samples}, at triggers or every {lines} lines"),
      TextKey("latch", "fetch", &fetch, "query that is answered by <samples>,<1: some are lost>,<the samples>"),
      TextKey("move", "command", &move, "an indexer: seats at {tooth}, which is at {deg}"),
      TextKey("move", "done", &done, "query whether it is seated; empty: it answers when it is"),
      TextKey("move", "seated", &seated, "what that is answered then"),
      TextKey("move", "stop", &stop, "command that ends a seating; it is not answered"),
      TextKey("tilt", "command", &tilt, "a goniometer: turns to {yaw}, {tilt}"),
      TextKey("tilt", "unit", &tilt_unit, "of both"),
  };
}

DialogueWords ParseDialogue(const std::string& text, const std::string& name) {
  DialogueWords words;
  words.name = name;
  const KeyPlaces places = ReadToml(text, name, words.Keys());
  DialogueCheck(words, places, name).Check();
  return words;
}

DialogueWords ReadyDialogueNamed(const std::string& name) {
  return LoadDialogue(name, "", "dialogue");
}

DialogueWords LoadDialogue(const std::string& name_or_path, const std::string& folder, const std::string& where) {
  if (!name_or_path.ends_with(".toml")) {
    const auto ready = std::ranges::find(ReadyDialogues(), name_or_path, &ReadyDialogue::name);
    if (ready != ReadyDialogues().end()) return ParseDialogue(ready->text, ready->name);
    throw InputError(where, fmt::format("there is no ready dialogue \"{}\"", name_or_path),
                     fmt::format("one of {}, or a file whose name ends in .toml", NamesOfReady()));
  }
  const std::string path = (std::filesystem::path(folder) / name_or_path).lexically_normal().string();
  return ParseDialogue(InputText(path, "a dialogue in TOML", where), path);
}

LineWords WithAnyLineEnd() {
  LineWords words;
  words.answer_ends = kAnyLineEnd;
  return words;
}

std::string EndOfLine(const std::string& name) {
  if (name == kAnyLineEnd) return "";
  if (name == "CRLF") return "\r\n";
  return name == "CR" ? "\r" : "\n";
}

double UnitToSI(const std::string& unit, const std::string& where) {
  return unit.empty() ? 1.0 : UnitAt(unit, where).to_SI;
}

double ScaleToColumn(const std::string& unit, const std::string& column, const std::string& where) {
  const std::string ending = column.substr(column.rfind('_') + 1);
  const DialogueUnit* of_column = UnitWith(ending);
  if (unit.empty() || unit == ending || !of_column) return 1.0;
  const DialogueUnit& told = UnitAt(unit, where);
  if (told.kind != of_column->kind)
    throw InputError(where, fmt::format("the field for {} is given in {}", column, unit),
                     "a unit that can be given in " + ending);
  return told.to_SI / of_column->to_SI;
}

}  // namespace twinbench::hw
