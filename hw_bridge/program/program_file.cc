#include "hw_bridge/program/program_file.h"

#include <algorithm>
#include <fstream>
#include <sstream>

#include "hw_bridge/file_places.h"
#include "twin/core/errors.h"
#include "twin/core/toml_reader.h"

namespace twinbench::hw {
namespace {

std::string ProgramTextOf(const std::string& path) {
  std::ifstream in(path);
  std::ostringstream text;
  if (!in || !(text << in.rdbuf()))
    throw InputError(path, "the file cannot be read or is empty", "a bench file in TOML");
  return text.str();
}

}  // namespace

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
  return TextAtTop(ProgramTextOf(path), path, "kind") == "program";
}

ProgramFile LoadProgramFile(const std::string& path) {
  ProgramFile file;
  file.path = path;
  const KeyPlaces places = ReadToml(ProgramTextOf(path), path, KeysOf(file));
  const std::string where = WhereIn(places, path, "command");
  if (file.command.empty())
    throw InputError(where, "there is no command", "command = [\"python3\", \"acquire.py\", ...]");
  const auto names_readings = [](const std::string& word) { return word.find("{readings}") != std::string::npos; };
  if (std::ranges::none_of(file.command, names_readings))
    throw InputError(where, "the command does not say where the readings go", "an argument with {readings}");
  return file;
}

}  // namespace twinbench::hw
