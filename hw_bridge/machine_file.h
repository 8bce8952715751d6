#pragma once

#include <array>

#include "hw_bridge/bench_file.h"
#include "hw_bridge/control/instrument_box.h"
#include "hw_bridge/numbers/number_source.h"
#include "twin/core/machine.h"

/// bench.toml of a bench whose machine is driven. docs/hardware.md lists every key.
namespace twinbench::hw {

inline constexpr std::size_t kMostInstruments = 4;  // [instrument_1] to [instrument_4]
inline constexpr double kTraverse_m_s = 1000.0 * units::mm / 60.0;

struct InstrumentSettings {
  ControlSettings connection{"none"};  // scpi | dialogue | modbus | iio | comedi | none
  InstrumentWords words;
  int unit = 1;                        // modbus: of several behind one gateway
  std::string uri = "local:", device;  // iio; iio and comedi

  /// Whether it is numbers in a card or behind a gateway, which nobody speaks to in lines.
  bool IsNumbers() const {
    return connection.kind == "modbus" || connection.kind == "iio" || connection.kind == "comedi";
  }
  /// As they stand in `read`, apart by commas.
  NumberSettings Numbers() const;
};

struct MachineFile {
  std::string path;               // for messages
  KeyPlaces places;               // of the keys that it has
  std::string kind = "hardware";  // hardware | twin | replay
  std::string name;               // for the record
  std::string record;             // replay: folder of the run; as in the file, or absolute once loaded
  int attempts = 3;               // at one reading, before the run stops
  ControlSettings machine;        // kind esp | linuxcnc
  double traverse_m_s = kTraverse_m_s;
  double stall_s = AxisLimits{}.stall_s, move_timeout_s = AxisLimits{}.move_timeout_s;
  std::vector<AxisLimits> axes;  // one an axis
  std::vector<std::string> letters;  // one an axis: linuxcnc, as programs name it; empty: by its own name
  std::vector<int> joints;           // one an axis: linuxcnc, which moves it
  std::array<InstrumentSettings, kMostInstruments> instruments;
  ControlSettings indexer{"none"};     // scpi | dialogue | console | none
  double indexer_timeout_s = 60.0;     // of one seating
  ControlSettings fixture{"console"};  // scpi | console
  ControlSettings clock{"host"};       // host | scpi
};

/// How a program of LinuxCNC names an axis: what the file says, or else the axis's own name.
std::string LetterOf(const MachineFile& file, const std::vector<MachineAxis>& axes, std::size_t axis);

/// Every key of the file format for a machine with these axes: [axis_x], ...
std::vector<ScenarioKey> KeysOf(MachineFile& file, const std::vector<MachineAxis>& axes);

/// @throws InputError with file:line, as LoadBenchFile does.
MachineFile LoadMachineFile(const std::string& path, const std::vector<MachineAxis>& axes);
/// @param folder  From which the files that it names are found.
MachineFile ParseMachineFile(const std::string& text, const std::string& name, const std::vector<MachineAxis>& axes,
                             const std::string& folder = "");

/// The bench file that drives what `twinbench serve` shows of such a bench.
/// @param machine  How the machine is driven: "esp" (over TCP) or "pty" (over the pseudo-terminal).
/// @param fields   Of a sample.
/// @param indexer  Whether there is one.
std::string WriteServedMachineFile(const ServedAddresses& addresses, const std::string& machine,
                                   const std::vector<std::string>& fields, bool indexer = false);

}  // namespace twinbench::hw
