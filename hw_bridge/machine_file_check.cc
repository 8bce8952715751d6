#include <fmt/format.h>

#include <utility>

#include "hw_bridge/control/address.h"
#include "hw_bridge/file_places.h"
#include "hw_bridge/machine_file_tables.h"
#include "twin/core/errors.h"

namespace twinbench::hw {
namespace {

/// What keys say together.
class MachineFileCheck {
 public:
  explicit MachineFileCheck(const MachineFile& file) : file_(file), places_(file.places) {}

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

void CheckMachineFile(const MachineFile& file, const std::vector<MachineAxis>& axes) {
  MachineFileCheck(file).Check(axes);
}

}  // namespace twinbench::hw
