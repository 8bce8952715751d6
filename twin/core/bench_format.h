#pragma once

#include <optional>
#include <string>
#include <vector>

#include "twin/core/effect_catalogue.h"
#include "twin/core/errors.h"
#include "twin/core/reading_column.h"

/// The text side of a bench: its names, its scenario's keys, its readings' columns and its catalogue of effects.
/// It needs nothing but this room; what can be done with a bench is in bench.h.
namespace twinbench {

struct Scenario;
struct ScenarioKey;
struct TableSettings;
class ScenarioText;

/// What the two tables of a bench are called in its files: "target" and "reference", or "turntable" and
/// "multitooth".
struct TableNames {
  std::string target, reference;
  TableSettings& (*settings)(Scenario&, bool of_reference) = nullptr;
};

/// What the channels of a bench read: a place on a detector [m], an angle [rad], or each something of its own, in
/// the unit of its column.
enum class SignalKind { kPosition, kAngle, kOwn };

/// A column (or several that go together) that a diagnosis can do without, at a price.
struct DesiredColumn {
  std::string name;
  bool (*is_there)(const Reading&);
  std::string lost;               // the causes that cannot be named without it
  bool calibration_only = false;  // it counts in that phase only
};

/// How the axis of an imported recording was driven.
struct ImportedCourse {
  bool stops = true;    // else in motion
  double turns = 0.0;   // from its lowest to its highest angle
  double turn_m = 0.0;  // a linear axis: the way that counts as a turn; 0: an angle
};

/// The two columns that a bench compares, of which the second should follow the first one to one: what an import
/// needs to know of a bench that reads anybody's recordings.
struct ComparedColumns {
  std::string reference, shown, velocity;
  /// Keys of a scenario, as --set has them, for such a recording.
  std::vector<std::string> (*scenario_of)(const ImportedCourse&) = nullptr;
};

struct BenchFormat {
  std::string name;                                                  // `bench` of its scenarios
  std::string title;                                                 // one line
  void (*add_keys)(std::vector<ScenarioKey>&, Scenario&) = nullptr;  // those of its own tables
  /// See scenario_together.h; null: any keys fit each other.
  void (*check_together)(const ScenarioText&, const Scenario&) = nullptr;
  std::optional<TableNames> tables = {};  // whose errors a file may give; nothing: it has no such tables
  bool has_fixtures = false;           // things may stand in its light: [[fixture]]
  std::vector<ReadingColumn> columns;  // of readings.csv, in the order of writing
  void (*into_frame)(std::vector<Reading>&) = nullptr;  // signs and origin that a file leaves open; null: they are fixed
  std::vector<DesiredColumn> desired;
  std::optional<ComparedColumns> compared = {};
  /// The largest size that a converter can give in a column [SI]; 0 where none is known. Null: of no column.
  double (*range_of)(const Scenario&, const std::string& column) = nullptr;
  std::string (*smallest_addition)(int setups) = nullptr;  // what would give a run of that many some redundancy
  std::vector<EffectEntry> effects;
  std::vector<std::string> channels;  // to which an [[empirical]] signal can be added
  std::vector<std::string> points;    // at which an [[effect]] "signal" can enter, in the order of the channels
  std::vector<std::string> angles;    // by which it can go; at most two
  SignalKind signal = SignalKind::kAngle;
};

/// Every bench that this program knows, in the order of the help. Core declares the list and does not make it:
/// twin/benches/formats.cc does, so that core stays free of names and the list is fixed when a program is linked.
const std::vector<const BenchFormat*>& BenchFormats();

std::vector<std::string> BenchNames();

/// The refusal of a name that no bench has: it names those there are, and the nearest.
/// @param where  File and line of the name.
InputError UnknownBench(const std::string& where, const std::string& name);

/// @return the bench with that name, or nullptr.
const BenchFormat* FindFormat(const std::string& bench);
/// @throws InputError if there is none.
const BenchFormat& FormatOf(const std::string& bench, const std::string& where = "bench");

/// The bench whose required columns are the most among those there are, or nullptr if no bench's own column is
/// among them. Only for files that come without a scenario and records that are too old to say.
/// @param has  Whether a column is there.
const BenchFormat* FormatByColumns(const std::function<bool(const ReadingColumn&)>& has);

}  // namespace twinbench
