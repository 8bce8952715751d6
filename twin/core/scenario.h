#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "twin/core/frames.h"
#include "twin/core/own_settings.h"
#include "twin/core/shared_settings.h"
#include "twin/core/stated_uncertainty.h"
#include "twin/core/units.h"

/// A scenario: one measurement on one bench, everything in SI. The structs below are the file format (see
/// settings.cc of each bench for keys, units and bounds). A key is a field's name with the unit of the file:
/// wavelength_m is `wavelength_nm`.
namespace twinbench {

/// Something opaque in the way of the light: a box, or a triangle mesh from a file. A [[fixture]] block.
struct FixtureSettings {
  std::string name;
  Vector3 box_m = Vector3::Constant(std::numeric_limits<double>::quiet_NaN());  // edges; NaN: a mesh
  std::string mesh_file;                 // STL; absolute once loaded; empty: a box
  double mesh_unit_m = 1.0 * units::mm;  // what the number 1 in it means
  Vector3 position_m = Vector3::Zero();  // of the box's centre or the mesh's origin, in L ...
  double yaw_rad = 0.0;                  // about z
  bool rides_on_grating = false;         // ... or in G, and it moves with the grating
  std::string location;                  // "file.toml:31", for messages
};

/// What a diagnosis said about the effect that it added to a scenario. The twin does not look at it.
struct EffectFinding {
  std::map<std::string, double> u;  // SI, by parameter: `u_roll_mrad`; those that are known
  double log_evidence = std::numeric_limits<double>::quiet_NaN();
  double probability = std::numeric_limits<double>::quiet_NaN();
  std::string provenance;  // which run said so, and when
};

/// One cause that the bench has and the nominal bench has not: an [[effect]] block.
struct EffectSettings {
  std::string name;                          // of EffectCatalogue(bench)
  std::string where;                         // channel, PSD or axis; empty where the effect has only one place
  std::map<std::string, double> parameters;  // SI, by name without unit ("roll"); all that the catalogue has
  std::string location;                      // "file.toml:31", for messages
  EffectFinding finding = {};                // if a diagnosis added it
  // Of a signal (signal_effect.h), whose point is `where`:
  std::string signal = {};  // its kind
  std::string by = {};      // the angle or channel that it goes by
  std::string times = {};   // what its size follows
};

/// Structure without a name: a tabulated signal. An [[empirical]] block. By time it says what any reading between
/// those that showed it had; by reading it repeats what one run had and predicts no other.
struct EmpiricalSettings {
  std::string signature = {};       // what it looks like, in words
  std::string channel = {};         // to which the signal is added
  std::string by = "reading";       // what it is tabulated by: "reading" or "time"
  std::vector<int> reading = {};    // by reading: running numbers, each once; elsewhere the signal is zero
  std::vector<double> time_s = {};  // by time: ascending, straight between, at the ends on; by reading: when
                                    // these were taken, or nothing. A record that was taken at other times has no
                                    // such signal
  std::vector<double> value_m = {};    // one a reading, on a channel that reads a position ...
  std::vector<double> value_rad = {};  // ... or an angle ...
  std::vector<double> value = {};  // ... or something else, in the unit of its column; the other lists are empty
  std::string provenance = {};
  std::string location = {};  // "file.toml:31", for messages
};

struct Scenario {
  std::string bench;  // its name; there is no usual one
  std::string title;
  std::uint64_t seed = 1;
  int repeat = 0;                   // which run of the same bench: chance differs, the bench itself does not
  bool noise_free = false;          // no random contribution and no quantisation
  EnvironmentSettings environment;  // of benches whose readings depend on it
  OwnSettings own;                  // the bench's own tables: settings.h in its folder
  std::vector<FixtureSettings> fixtures;
  std::vector<EffectSettings> effects;
  std::vector<EmpiricalSettings> empiricals;
  std::vector<StatedUncertainty> uncertainties;  // of its keys, in their order

  /// Of what differs from run to run: noise, seating, the room. `seed` alone is of what stays: the errors that a
  /// table was made with.
  std::uint64_t RunSeed() const;
};

/// Reads a scenario of any bench there is (BenchFormats) and applies `overrides`: "procedure.positions=12", in TOML
/// syntax, where a single word needs no quotes. A later override wins. A list, or all blocks of [[fixture]],
/// [[effect]] or [[empirical]], are replaced as a whole.
///
/// @throws InputError with file:line for a syntax error, an unknown key (naming the nearest known one), a value out
///         of bounds or of the wrong type, no bench or an unknown one, a key of another bench, an effect, place or
///         parameter that is not in the bench's catalogue, a file that cannot be read. Overrides are reported as
///         "--set key=value".
Scenario LoadScenario(const std::string& path, const std::vector<std::string>& overrides = {});
Scenario ParseScenario(const std::string& text, const std::string& name, const std::string& folder,
                       const std::vector<std::string>& overrides = {});

/// With other values of keys, as `overrides` say. @throws InputError as ParseScenario does.
Scenario Altered(const Scenario& scenario, const std::vector<std::string>& sets);

/// The bench that a scenario file names; nothing else in it is looked at.
/// @throws InputError if it is no TOML, or names no bench or an unknown one.
std::string BenchOfScenarioFile(const std::string& path);

/// The scenario as TOML with every key of its bench written out, units in the keys; LoadScenario reads it back to
/// the same bits. It stands alone: errors of the tables are in it, and other files are named by absolute paths.
/// @throws std::logic_error if a number is not finite.
std::string WriteScenario(const Scenario& scenario);

/// Every key with unit, default, bounds and meaning, for `twinbench help scenario` and docs.
std::string DescribeScenarioKeys();

}  // namespace twinbench
