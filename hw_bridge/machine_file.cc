#include "hw_bridge/machine_file.h"

#include <fmt/format.h>

#include <filesystem>
#include <sstream>

#include "hw_bridge/bench_dialogue.h"
#include "hw_bridge/control/address.h"
#include "hw_bridge/file_places.h"
#include "twin/core/errors.h"
#include "twin/core/input_text.h"
#include "twin/core/toml_reader.h"

namespace twinbench::hw {
namespace {

constexpr Unit kOne{}, kSeconds{"s"}, kMillimetresASecond{"mm_s", units::mm};
constexpr double kFurthest = 1e6;
constexpr int kMostJoints = 8;

Bounds Above(double lower, double upper) {
  return {lower, upper, true};
}

std::string InstrumentTable(std::size_t number) {
  return fmt::format("instrument_{}", number + 1);
}

std::string AxisTable(const MachineAxis& axis) {
  return "axis_" + axis.name;
}

class MachineKeys {
 public:
  MachineKeys(std::vector<ScenarioKey>& keys, std::string table) : keys_(keys), table_(std::move(table)) {}

  void Add(const std::string& name, const Unit& unit, const Bounds& bounds, Field field,
           const std::string& meaning) {
    keys_.push_back({table_, name, unit, bounds, {}, field, meaning});
  }
  void Text(const std::string& name, Field field, std::vector<std::string> choices, const std::string& meaning) {
    keys_.push_back({table_, name, {}, {}, std::move(choices), field, meaning});
  }
  void Described(ControlSettings& s, std::vector<std::string> kinds) {
    Connection(s, std::move(kinds));
    Text("dialogue", &s.dialogue, {}, "kind dialogue: a ready one, or a file that ends in .toml, from the bench file's folder");
  }
  void Connection(ControlSettings& s, std::vector<std::string> kinds) {
    Text("kind", &s.kind, std::move(kinds), "language, or who does it");
    Text("address", &s.address, {}, "where it is reached");
    Text("identity", &s.identity, {}, "what its answer to *IDN? or VE? must begin with; empty: any");
    Text("token", &s.token, {}, "of a served twin that asks for one; empty: none");
    Text("watchdog", &s.watchdog, {}, "command that arms the controller's own, after every opening; empty: it has none");
    Add("timeout", kSeconds, Above(0.0, 3600.0), &s.timeout_s, "of one answer");
  }

 private:
  std::vector<ScenarioKey>& keys_;
  std::string table_;
};

void AddInstrument(std::vector<ScenarioKey>& keys, std::size_t number, InstrumentSettings& s) {
  MachineKeys t(keys, InstrumentTable(number));
  t.Described(s.connection, {"scpi", "dialogue", "modbus", "iio", "comedi", "none"});
  t.Text("fields", &s.words.fields, {}, "of a sample, in order: columns, time_ns, status, ignored");
  t.Add("scale", kOne, {}, &s.words.scale, "field times this is in the column's unit, one a field; without it 1");
  t.Text(
      "read", &s.words.read, {},
      "query that is answered by one sample; of modbus, iio, comedi what is read, one a field with commas between");
  t.Text("look", &s.words.look, {}, "the same on the way to a reading, where something is nulled; empty: as read");
  t.Text("arm", &s.words.arm, {}, "command that lets it latch {samples}, at triggers or every {lines} lines; empty: it cannot");
  t.Text("fetch", &s.words.fetch, {}, "query that is answered by <samples>,<1: some are lost>,<the samples>");
  t.Add("unit", kOne, {0, 255}, &s.unit, "modbus: of several devices behind one gateway");
  t.Text("uri", &s.uri, {}, "iio: where the context is, as libiio takes it");
  t.Text("device", &s.device, {}, "iio: name or id of the device; comedi: device file");
}

void AddIndexer(std::vector<ScenarioKey>& keys, MachineFile& file) {
  MachineKeys t(keys, "indexer");
  t.Described(file.indexer, {"scpi", "dialogue", "console", "none"});
  t.Text("move", &file.indexer.words.move, {}, "command that seats it at {tooth}, which is at {deg}");
  t.Text("done", &file.indexer.words.done, {}, "query that is answered by 1 once it is seated; empty: none");
  t.Text("stop", &file.indexer.words.stop, {}, "command that ends a seating, which is not answered; empty: none");
  t.Add("move_timeout", kSeconds, Above(0.0, 3600.0), &file.indexer_timeout_s, "of one seating");
}

/// What keys say together.
class MachineFileCheck {
 public:
  MachineFileCheck(const MachineFile& file, const KeyPlaces& places) : file_(file), places_(places) {}

  void Check(const std::vector<MachineAxis>& axes) const {
    CheckRecord(places_, file_.path, file_.kind, file_.record);
    if (file_.kind != "hardware") return RefuseDevices(places_, file_.kind, {"kind", "name", "record", "attempts"});
    CheckConnection("machine", file_.machine);
    if (file_.machine.kind.empty())
      throw InputError(Where("machine"), "there is no [machine] with a kind", "kind = \"esp\" or \"linuxcnc\"");
    for (std::size_t k = 0; k < axes.size(); ++k) CheckAxis(axes[k], file_.axes[k]);
    file_.machine.kind == "linuxcnc" ? CheckLinuxCnc(axes) : RefuseLinuxCnc(axes);
    CheckInstruments();
    CheckConnection("indexer", file_.indexer);
    if (file_.indexer.kind == "dialogue") RefuseWords("indexer", {"move", "done", "stop"});
    CheckPairs();
    CheckConnection("fixture", file_.fixture);
    CheckConnection("clock", file_.clock);
  }

 private:
  std::string Where(const std::string& path) const { return WhereIn(places_, file_.path, path); }

  void CheckConnection(const std::string& table, const ControlSettings& s) const {
    const bool connected = HasConnection(s.kind);
    const std::string key = table + ".address";
    if (!connected && !s.address.empty())
      throw InputError(Where(key), fmt::format("{} with kind = \"{}\"", key, s.kind), "no address");
    if (connected && !ParseAddress(s.address))
      throw InputError(Where(key), fmt::format("{} is \"{}\"", key, s.address), kAddressForm);
    RequireTokenText(Where(table + ".token"), s.token);
  }

  void CheckAxis(const MachineAxis& axis, const AxisLimits& limits) const {
    if (limits.lower < limits.upper) return;
    throw InputError(Where(AxisTable(axis)),
                     fmt::format("the upper limit of axis {} is not above its lower", axis.name),
                     "a range to move in");
  }

  void CheckLinuxCnc(const std::vector<MachineAxis>& axes) const {
    RefuseOf("machine.token", "linuxcncrsh has none", "connect_password and enable_password");
    RefuseOf("machine.watchdog", "linuxcncrsh has none", "no watchdog");
    if (file_.clock.kind != "host")
      throw InputError(Where("clock.kind"),
                       "the clock of a served twin beside a LinuxCNC machine, which goes in real time", "\"host\"");
    for (const auto& [key, password] : {std::pair{"machine.connect_password", file_.machine.connect_password},
                                        std::pair{"machine.enable_password", file_.machine.enable_password}}) {
      if (password.empty() || password.find_first_of(" \t\r\n") != std::string::npos)
        throw InputError(Where(key), fmt::format("{} is empty or has blanks", key),
                         "one word, as linuxcncrsh was started with");
    }
    for (std::size_t k = 0; k < axes.size(); ++k) CheckLetter(axes, k);
  }

  void CheckLetter(const std::vector<MachineAxis>& axes, std::size_t k) const {
    const std::string table = AxisTable(axes[k]), letter = LetterOf(file_, axes, k);
    const std::string letters = axes[k].is_rotary ? "ABC" : "XYZ";
    if (letter.size() != 1 || letters.find(letter) == std::string::npos)
      throw InputError(Where(places_.contains(table + ".letter") ? table + ".letter" : table),
                       fmt::format("axis {} has no letter at LinuxCNC", axes[k].name),
                       fmt::format("{}.letter, {}, {} or {}", table, letters[0], letters[1], letters[2]));
    for (std::size_t other = 0; other < k; ++other) {
      const bool is_same = letter == LetterOf(file_, axes, other),
                 shares_joint = file_.joints[k] == file_.joints[other];
      if (is_same || shares_joint)
        throw InputError(Where(table),
                         fmt::format("axes {} and {} have the same {}", axes[other].name, axes[k].name,
                                     is_same ? "letter" : "joint"),
                         "one each");
    }
  }

  /// What only LinuxCNC knows.
  void RefuseLinuxCnc(const std::vector<MachineAxis>& axes) const {
    const std::string what = fmt::format("kind = \"{}\" knows no such thing", file_.machine.kind),
                      expected = "it with kind = \"linuxcnc\" only";
    for (const char* key : {"machine.connect_password", "machine.enable_password"}) RefuseOf(key, what, expected);
    for (const MachineAxis& axis : axes) {
      for (const char* key : {".letter", ".joint"}) RefuseOf(AxisTable(axis) + key, what, expected);
    }
  }

  void RefuseOf(const std::string& key, const std::string& what, const std::string& expected) const {
    if (places_.contains(key)) throw InputError(Where(key), fmt::format("{}: {}", key, what), expected);
  }

  void CheckInstruments() const {
    bool any = false;
    for (std::size_t k = 0; k < kMostInstruments; ++k) {
      const InstrumentSettings& s = file_.instruments[k];
      const std::string table = InstrumentTable(k);
      CheckConnection(table, s.connection);
      if (s.connection.kind == "none") continue;
      any = true;
      const bool is_described = s.connection.kind == "dialogue";
      s.IsNumbers() ? CheckNumbers(table, s) : RefuseNumbers(table);
      if (is_described) RefuseWords(table, {"read", "look", "arm", "fetch"});
      if (s.words.fields.empty() && !is_described)
        throw InputError(Where(table), fmt::format("{}.fields is missing", table), "the fields of its answer");
      if (!is_described && !s.words.scale.empty() && s.words.scale.size() != s.words.fields.size())
        throw InputError(Where(table + ".scale"),
                         fmt::format("{} scales for {} fields", s.words.scale.size(), s.words.fields.size()),
                         "one a field");
      CheckShared(table, s.connection);
    }
    if (!any) throw InputError(file_.path + ":1", "there is no instrument", "[instrument_1] with kind = \"scpi\"");
  }

  /// What stands in a dialogue stands there only.
  void RefuseWords(const std::string& table, const std::vector<std::string>& keys) const {
    for (const std::string& key : keys) RefuseOf(table + "." + key, "beside a dialogue", "it in the dialogue");
  }

  void CheckNumbers(const std::string& table, const InstrumentSettings& s) const {
    const std::string& kind = s.connection.kind;
    if (!HasNumberDriver(kind))
      throw InputError(Where(table + ".kind"), fmt::format("this build was made without the driver \"{}\"", kind),
                       "another kind");
    for (const char* key : {"identity", "token", "watchdog", "look", "arm", "fetch"})
      RefuseOf(table + "." + key, fmt::format("kind = \"{}\" is read, not spoken to", kind),
               fmt::format("no {}", key));
    const bool is_modbus = kind == "modbus";
    if (!is_modbus) RefuseOf(table + ".unit", "of modbus only", "no unit");
    if (kind != "iio") RefuseOf(table + ".uri", "of iio only", "no uri");
    if (is_modbus) RefuseOf(table + ".device", "of iio and comedi only", "an address");
    if (!is_modbus && s.device.empty())
      throw InputError(Where(table), fmt::format("{}.device is missing", table), "what is read");
    const NumberSettings numbers = s.Numbers();
    if (!places_.contains(table + ".read") || numbers.items.size() != s.words.fields.size())
      throw InputError(
          Where(table + ".read"),
          fmt::format("{} is read for {} fields", places_.contains(table + ".read") ? numbers.items.size() : 0,
                      s.words.fields.size()),
          "one a field: " + NumberItemForm(kind));
    MakeNumberSource(numbers, table, Where(table + ".read"));  // which looks at every item
  }

  void RefuseNumbers(const std::string& table) const {
    for (const char* key : {"unit", "uri", "device"})
      RefuseOf(table + "." + key, "beside an instrument that is spoken to",
               "kind = \"modbus\", \"iio\" or \"comedi\"");
  }

  /// Who shares an address shares a connection: one language, one identity.
  void CheckShared(const std::string& table, const ControlSettings& s) const {
    if (s.address != file_.machine.address) return;
    throw InputError(Where(table + ".address"), fmt::format("{} shares the address of the machine", table),
                     "an address of its own: the machine speaks another language");
  }

  void CheckPairs() const {
    std::vector<std::pair<std::string, const ControlSettings*>> devices = {{"indexer", &file_.indexer}};
    for (std::size_t k = 0; k < kMostInstruments; ++k)
      devices.emplace_back(InstrumentTable(k), &file_.instruments[k].connection);
    for (auto a = devices.begin(); a != devices.end(); ++a) {
      for (auto b = a + 1; b != devices.end(); ++b) {
        const bool is_shared = !a->second->address.empty() && a->second->address == b->second->address;
        if (is_shared && !SpeakAlike(*a->second, *b->second))
          throw InputError(Where(b->first + ".address"), fmt::format("{} shares the address of {}", b->first, a->first),
                           "the same kind, identity, token, watchdog and way of speaking, then");
      }
    }
  }

  const MachineFile& file_;
  const KeyPlaces& places_;
};

}  // namespace

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

std::vector<ScenarioKey> KeysOf(MachineFile& file, const std::vector<MachineAxis>& axes) {
  std::vector<ScenarioKey> keys;
  file.indexer.words.move = ReadyDialogueNamed("served_indexer").move;  // unless the file says otherwise
  MachineKeys top(keys, "");
  top.Text("kind", &file.kind, {"hardware", "twin", "replay"}, "what stands there");
  top.Text("name", &file.name, {}, "of the bench, for the record");
  top.Text("record", &file.record, {}, "replay: folder of the recorded run, from the bench file's folder");
  top.Add("attempts", kOne, {1, 100}, &file.attempts, "at one reading, before the run stops");
  MachineKeys machine(keys, "machine");
  machine.Connection(file.machine, {"esp", "linuxcnc"});
  machine.Text("connect_password", &file.machine.connect_password, {},
               "linuxcnc: what linuxcncrsh was started with (--connectpw)");
  machine.Text("enable_password", &file.machine.enable_password, {},
               "linuxcnc: what linuxcncrsh was started with (--enablepw)");
  machine.Add("decimals", kOne, {-1, 15}, &file.machine.decimals,
              "behind the point of a number that the controller understands; -1: all that matter");
  machine.Add("traverse", kMillimetresASecond, Above(0.0, 1e4), &file.traverse_m_s, "feed of moves without a feed");
  machine.Add("stall", kSeconds, Above(0.0, 3600.0), &file.stall_s, "it may stand still so long during a move");
  machine.Add("move_timeout", kSeconds, Above(0.0, 36000.0), &file.move_timeout_s, "beyond what a path takes");
  file.axes.resize(axes.size());
  file.letters.resize(axes.size());
  file.joints.resize(axes.size());
  for (std::size_t k = 0; k < axes.size(); ++k) {
    MachineKeys t(keys, AxisTable(axes[k]));
    const Unit unit{axes[k].unit(), axes[k].to_SI()};
    const Unit fine = axes[k].is_rotary ? Unit{"arcsec", units::arcsec} : Unit{"um", units::um};
    t.Add("lower", unit, {-kFurthest, kFurthest}, &file.axes[k].lower,
          "soft limit; without it the controller's own");
    t.Add("upper", unit, {-kFurthest, kFurthest}, &file.axes[k].upper,
          "soft limit; without it the controller's own");
    t.Add("in_position", fine, Above(0.0, 1e9), &file.axes[k].in_position, "encoder against command when settled");
    t.Text("letter", &file.letters[k], {},
           "linuxcnc: X, Y, Z, A, B or C, as programs name it; without it the axis's own name");
    file.joints[k] = static_cast<int>(k);
    t.Add("joint", kOne, {0, kMostJoints}, &file.joints[k],
          "linuxcnc: that moves it; without it axes have joints 0, 1, ... in their order");
  }
  for (std::size_t k = 0; k < kMostInstruments; ++k) AddInstrument(keys, k, file.instruments[k]);
  AddIndexer(keys, file);
  MachineKeys(keys, "fixture").Connection(file.fixture, {"scpi", "console"});
  MachineKeys(keys, "clock").Connection(file.clock, {"host", "scpi"});
  return keys;
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
  MachineFileCheck(file, file.places).Check(axes);
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
