#include "hw_bridge/bench_dialogue.h"

#include <fmt/format.h>

#include <algorithm>

#include "hw_bridge/file_places.h"
#include "twin/core/errors.h"

namespace twinbench::hw {
namespace {

constexpr const char* kDialogueKind = "dialogue";

struct Need {
  const char* served;  // the ready dialogue of a served twin; empty: kind "scpi" needs none
  std::vector<std::string> fields;
  std::string DialogueWords::*words;
  const char* missing;  // in words
};

Need NeedOf(DialogueRole role) {
  switch (role) {
    case DialogueRole::kAutocollimator:
      return {"served_autocollimator", {"x", "y"}, nullptr, "fields \"x\" and \"y\" in [read]"};
    case DialogueRole::kThermometer:
      return {"served_thermometer", {"temperature"}, nullptr, "a field \"temperature\" in [read]"};
    case DialogueRole::kGoniometer:
      return {"served_goniometer", {}, &DialogueWords::tilt, "command of [tilt]"};
    case DialogueRole::kIndexer:
      return {"", {}, &DialogueWords::move, "command of [move]"};
    case DialogueRole::kInstrument:
      break;
  }
  return {"", {}, nullptr, "ask and fields of [read]"};
}

bool Has(const DialogueWords& words, const Need& need) {
  const auto is_field = [&](const std::string& field) { return std::ranges::count(words.read.fields, field) == 1; };
  if (need.words) return !(words.*need.words).empty();
  return !words.read.ask.empty() && std::ranges::all_of(need.fields, is_field);
}

}  // namespace

bool HasConnection(const std::string& kind) {
  return kind == "scpi" || kind == "esp" || kind == "linuxcnc" || kind == "modbus" || kind == kDialogueKind;
}

void TakeWords(const std::string& file, const KeyPlaces& places, const std::string& folder,
               const std::string& table, DialogueRole role, ControlSettings& settings) {
  const std::string where = WhereIn(places, file, table + ".dialogue");
  const Need need = NeedOf(role);
  if (settings.kind != kDialogueKind && !settings.dialogue.empty())
    throw InputError(where, fmt::format("{}.dialogue with kind = \"{}\"", table, settings.kind),
                     "kind = \"dialogue\"");
  if (settings.kind == "scpi" && *need.served) settings.words = ReadyDialogueNamed(need.served);
  if (settings.kind != kDialogueKind) return;
  if (settings.dialogue.empty())
    throw InputError(where, fmt::format("{}.dialogue is missing", table),
                     "a ready one by its name, or a file that ends in .toml");
  for (const char* key : {"token", "watchdog"}) {
    if (places.contains(table + "." + key))
      throw InputError(places.at(table + "." + key), fmt::format("{}.{} with kind = \"dialogue\"", table, key),
                       "kind = \"scpi\", which has a word for it");
  }
  settings.words = LoadDialogue(settings.dialogue, folder, where);
  if (settings.words.identify.empty() && !settings.identity.empty())
    throw InputError(
        WhereIn(places, file, table + ".identity"),
        fmt::format("{}.identity with dialogue {}, whose device does not tell who it is", table, settings.dialogue),
        "no identity, or identify in the dialogue");
  if (!Has(settings.words, need))
    throw InputError(where, fmt::format("dialogue {} does not say what [{}] needs", settings.dialogue, table),
                     need.missing);
}

bool SpeakAlike(const ControlSettings& a, const ControlSettings& b) {
  return a.kind == b.kind && a.identity == b.identity && a.token == b.token && a.watchdog == b.watchdog &&
         (a.kind != kDialogueKind || (a.words.identify == b.words.identify && a.words.line == b.words.line));
}

}  // namespace twinbench::hw
