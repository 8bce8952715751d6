#include "hw_bridge/program/program_file.h"

#include <algorithm>

#include "hw_bridge/file_places.h"
#include "twin/core/errors.h"
#include "twin/core/input_text.h"
#include "twin/core/toml_reader.h"

namespace twinbench::hw {
std::vector<ScenarioKey> KeysOf(ProgramFile& file) {
  const std::vector<std::string> any;
  std::vector<ScenarioKey> keys;
  keys.push_back({"", "kind", {}, {}, {"program"}, &file.kind, "what stands there"});
  keys.push_back({"", "name", {}, {}, any, &file.name, "of the bench, for the record"});
  keys.push_back({"",
                  "command",
                  {},
                  {},
                  any,
                  &file.command,
                  "program and arguments; {scenario}, {stops} and {readings} are put in"});
  keys.push_back({"", "timeout", {"s"}, {0.0, 1e7, true}, any, &file.timeout_s, "a run may take so long"});
  return keys;
}

bool IsProgramFile(const std::string& path) {
  return TextAtTop(InputText(path, "a bench file in TOML"), path, "kind") == "program";
}

ProgramFile LoadProgramFile(const std::string& path) {
  ProgramFile file;
  file.path = path;
  const KeyPlaces places = ReadToml(InputText(path, "a bench file in TOML"), path, KeysOf(file));
  const std::string where = WhereIn(places, path, "command");
  if (file.command.empty())
    throw InputError(where, "there is no command", "command = [\"python3\", \"acquire.py\", ...]");
  const auto names_readings = [](const std::string& word) { return word.find("{readings}") != std::string::npos; };
  if (std::ranges::none_of(file.command, names_readings))
    throw InputError(where, "the command does not say where the readings go", "an argument with {readings}");
  return file;
}

}  // namespace twinbench::hw
