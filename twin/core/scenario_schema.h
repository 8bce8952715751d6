#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "twin/core/scenario.h"

namespace twinbench {

/// The ending of a key and what it means.
struct Unit {
  std::string_view suffix;  // "nm"; empty for a pure number
  double to_SI = 1.0;
};

/// Bounds of a number as the user writes it, in the unit of its key.
struct Bounds {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  bool above_lower = false;  // the lower bound itself is excluded

  bool Contain(double value) const;
  std::string Text() const;  // " from 0 to 10", " above 0", "" without bounds
};

struct ScenarioKey;

/// A list of tables of one kind: `mounts = [{ z_mm = 60.0, yaw_deg = 90.0 }, ...]`. What a table leaves out keeps
/// its default.
struct RecordList {
  std::function<std::size_t()> size;
  std::function<void(std::size_t)> start_anew;                   // that many, all with defaults
  std::function<std::vector<ScenarioKey>(std::size_t)> keys_of;  // of one; without a table's name
  std::function<std::vector<ScenarioKey>()> example_keys;        // of one with defaults
};

/// Where a value of a scenario lives. A span is a list of fixed length, a vector one of at least one entry.
using Field =
    std::variant<double*, int*, std::uint64_t*, bool*, std::string*, std::span<double>, std::vector<double>*,
                 std::vector<int>*, std::vector<std::string>*, std::vector<HarmonicSettings>*,
                 std::optional<TableErrors>*, std::optional<CompensationTable>*, RecordList>;

/// One key of the file format, bound to the scenario that it was asked for.
struct ScenarioKey {
  std::string table;  // "laser", "target.random"; empty at the top
  std::string name;   // without its unit
  Unit unit;
  Bounds bounds;                     // of every number
  std::vector<std::string> choices;  // allowed texts; empty: any
  Field field;
  std::string meaning;
  bool names_a_file = false;  // from the scenario's folder; absolute once loaded

  std::string Name() const { return unit.suffix.empty() ? name : name + "_" + std::string(unit.suffix); }
  std::string Path() const { return table.empty() ? Name() : table + "." + Name(); }
};

/// The description of the file format: every key of a scenario of its bench but those of its [[...]] blocks, in the
/// order of the file, the keys of a table before those of the tables inside it. Reading, writing, help and --set
/// all go through it.
/// @throws InputError if there is no such bench.
std::vector<ScenarioKey> KeysOf(Scenario& scenario);

/// The same of one [[fixture]] block, and of one [[empirical]] block.
std::vector<ScenarioKey> KeysOf(FixtureSettings& fixture);
std::vector<ScenarioKey> KeysOf(EmpiricalSettings& empirical);

/// Keys with their defaults, meanings and bounds, a heading for each table; for people.
std::string DescribeKeys(const std::vector<ScenarioKey>& keys);

}  // namespace twinbench
