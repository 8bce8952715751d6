#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hw_bridge/control/dialogue_words.h"
#include "twin/core/scenario_schema.h"
#include "twin/core/table_limits.h"
#include "twin/core/toml_reader.h"

/// bench.toml: which devices stand on the table and how they are reached. docs/hardware.md lists every key.
namespace twinbench::hw {

struct AdSettings {                          // [adc]
  std::string kind;                          // iio | comedi
  std::string uri = "ip:127.0.0.1";          // iio: as libiio takes it
  std::string device;                        // iio: "psd-adc16"; comedi: "/dev/comedi0"
  std::vector<std::string> channels;         // of psd_a_x, psd_a_y, psd_b_x, psd_b_y: "voltage0" or "0"
  int subdevice = -1;                        // comedi: -1 looks for the first analogue input
  std::string reference = "ground";          // ground | common | differential
  std::string light;                         // where "ok" | "no_light" | "clipped_spot" is told: an attribute (iio), a
                                             // digital input subdevice (comedi); empty: not wired
  std::string serial;                        // expected; empty: any
  std::string calibration_file;              // comedi softcal; empty: nominal; absolute once loaded
  double timeout_s = 2.0;                    // for a block, beyond its own length
  double rate_tolerance = 1e-6;              // relative; a card that is further off is refused
  double mains_Hz = 50.0;
};

struct ControlSettings {                     // [target], [reference], [autocollimator], [thermometer], ...
  std::string kind;                          // scpi | esp | console | none
  std::string address = "";                  // "tcp:HOST:PORT", "serial:/dev/ttyUSB0:19200"
  int axis = 1;
  std::string identity = "";                 // what *IDN? or VE? must begin with; empty: any, but the same all along
  std::string token = "";                    // shown to a served twin that asks for one, before anything is moved
  std::string watchdog = "";                 // command that arms the controller's own; empty: it has none
  double timeout_s = 2.0;                    // of one answer
  int decimals = -1;                         // digits behind the point in commands; -1: all that matter
  std::string connect_password = "EMC", enable_password = "EMCTOO";  // of linuxcncrsh
  std::string dialogue = "";                 // kind dialogue: a ready one, or a file
  DialogueWords words = {};                  // of instruments that are spoken to by one
};

/// What is asked of a real table unless the file says otherwise.
inline constexpr TableLimits kHardwareLimits = {.in_position_rad = 1.0 * units::arcsec};

struct BenchFile {
  std::string path;                          // for messages
  KeyPlaces places;                          // of the keys that it has
  std::string kind = "hardware";             // hardware | twin | replay
  std::string name;                          // for the record
  std::string record;                        // replay: folder of the run; absolute once loaded
  double jump_V = std::numeric_limits<double>::infinity();  // of a channel between neighbouring stops; more is implausible
  int attempts = 3;                          // at one reading, before the run stops
  AdSettings adc;
  ControlSettings target, reference;         // kind scpi | esp
  ControlSettings autocollimator{"none"};    // scpi | none
  ControlSettings thermometer{"none"};       // scpi | none
  ControlSettings goniometer{"none"};        // scpi | console | none
  ControlSettings fixture{"console"};        // scpi | console
  ControlSettings clock{"host"};             // host | scpi
  TableLimits target_limits = kHardwareLimits, reference_limits = kHardwareLimits;
};

/// Every key of the file format, bound to `file`: units, bounds, choices, meaning.
std::vector<ScenarioKey> KeysOf(BenchFile& file);

/// @throws InputError with file:line for a syntax error, an unknown key (naming the nearest), a missing device, a value
///         out of bounds, settings that do not go together, a backend that this build does not have.
BenchFile LoadBenchFile(const std::string& path);
/// @param name    Of the file, for messages.
/// @param folder  From which the files that it names are found.
BenchFile ParseBenchFile(const std::string& text, const std::string& name, const std::string& folder);

/// How such a file begins.
inline constexpr const char* kServedBenchFile = "# What `twinbench serve` shows, as `twinbench measure --bench` takes it.\n";
/// The bench file that drives what `twinbench serve` shows at these ports.
struct ServedAddresses {
  std::string host = "127.0.0.1";
  int iiod_port = 0, scpi_port = 0, esp_port = 0;
  std::string pty;                           // empty: none
};
/// A served twin's bench file that shows `token` on every connection that has an identity, and arms the watchdog there.
/// @param token  Empty: none.
std::string WithGuards(const std::string& bench_file, const std::string& token);
/// @throws InputError at `where` unless it can be said in any of the languages: letters and digits, or nothing.
void RequireTokenText(const std::string& where, const std::string& token);
/// @param tables  How the tables are driven: "scpi", "esp" (over TCP) or "pty" (ESP over the pseudo-terminal).
std::string WriteServedBenchFile(const ServedAddresses& addresses, const std::string& tables);

}  // namespace twinbench::hw
