#include "hw_bridge/machine_file.h"

#include <fmt/format.h>

#include <filesystem>
#include <sstream>

#include "hw_bridge/bench_dialogue.h"
#include "hw_bridge/file_places.h"
#include "hw_bridge/machine_file_tables.h"
#include "twin/core/errors.h"
#include "twin/core/input_text.h"
#include "twin/core/toml_reader.h"

namespace twinbench::hw {

NumberSettings InstrumentSettings::Numbers() const {
  NumberSettings numbers = {.kind = connection.kind,
                            .address = connection.address,
                            .unit = unit,
                            .uri = uri,
                            .device = device,
                            .items = {},
                            .timeout = FromSeconds(connection.timeout_s)};
  std::istringstream in(words.read);
  for (std::string item; std::getline(in >> std::ws, item, ',');) numbers.items.push_back(item);
  return numbers;
}

std::string LetterOf(const MachineFile& file, const std::vector<MachineAxis>& axes, std::size_t axis) {
  std::string letter = file.letters[axis].empty() ? axes[axis].name : file.letters[axis];
  for (char& c : letter) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return letter;
}

MachineFile ParseMachineFile(const std::string& text, const std::string& name, const std::vector<MachineAxis>& axes,
                             const std::string& folder) {
  MachineFile file;
  file.path = name;
  file.places = ReadToml(text, name, KeysOf(file, axes));
  TakeWords(name, file.places, folder, "indexer", DialogueRole::kIndexer, file.indexer);
  for (std::size_t k = 0; k < kMostInstruments; ++k) {
    file.instruments[k].words.where = WhereIn(file.places, name, InstrumentTable(k) + ".fields");
    TakeWords(name, file.places, folder, InstrumentTable(k), DialogueRole::kInstrument, file.instruments[k].connection);
  }
  CheckMachineFile(file, axes);
  for (AxisLimits& limits : file.axes) {
    limits.stall_s = file.stall_s;
    limits.move_timeout_s = file.move_timeout_s;
  }
  return file;
}

MachineFile LoadMachineFile(const std::string& path, const std::vector<MachineAxis>& axes) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  MachineFile file = ParseMachineFile(InputText(path, "a bench file in TOML"), path, axes, folder);
  MakeAbsolute(folder, file.record);
  return file;
}

std::string WriteServedMachineFile(const ServedAddresses& a, const std::string& machine,
                                   const std::vector<std::string>& fields, bool indexer) {
  Require(machine == "esp" || machine == "pty", "a machine is driven by esp or pty");
  Require(machine != "pty" || !a.pty.empty(), "there is no pseudo-terminal");
  const std::string scpi = fmt::format(
      "kind = \"scpi\"\naddress = \"tcp:{}:{}\"\nidentity = \"twinbench,machine-bench,\"\n", a.host, a.scpi_port);
  const std::string esp = machine == "pty" ? "serial:" + a.pty : fmt::format("tcp:{}:{}", a.host, a.esp_port);
  std::string list;
  for (const std::string& field : fields) list += (list.empty() ? "\"" : ", \"") + field + "\"";
  return fmt::format(
      "# What `twinbench serve` shows, as `twinbench measure --bench` takes it.\n"
      "kind = \"hardware\"\nname = \"served twin\"\n\n"
      "[machine]\nkind = \"esp\"\naddress = \"{}\"\nidentity = \"ESP301 twinbench \"\ntraverse_mm_s = 200.0\n\n"
      "[instrument_1]\n{}look = \"INST:LOOK?\"\narm = \"INST:ARM {{samples}},{{lines}}\"\nfields = [{}]\n\n{}[fixture]\n{}\n[clock]\n{}",
      esp, scpi, list, indexer ? "[indexer]\n" + scpi + "\n" : "", scpi, scpi);
}

}  // namespace twinbench::hw
