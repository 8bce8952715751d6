#include "hw_bridge/bench_dialogue.h"
#include "hw_bridge/machine_file_tables.h"

namespace twinbench::hw {
namespace {

constexpr Unit kOne{}, kSeconds{"s"}, kMillimetresASecond{"mm_s", units::mm};
constexpr double kFurthest = 1e6;
constexpr int kMostJoints = 8;

Bounds Above(double lower, double upper) {
  return {lower, upper, true};
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

}  // namespace

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

}  // namespace twinbench::hw
