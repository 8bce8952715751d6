#pragma once

#include <string>
#include <vector>

#include "twin/core/bench_format.h"
#include "twin/import/layout.h"
#include "twin/import/table.h"
#include "twin/import/unit_names.h"

/// What is said once about a kind of file: how it is laid out, which of its columns are which quantities of the
/// bench, and how the axis moved. Everything may be left out that the file itself tells.
namespace twinbench::imports {

/// A quantity of the bench as a map gives it.
struct MappedColumn {
  std::string column;      // of the bench: "reference_deg"
  std::string expression;  // of the file's columns; empty: not given
  std::string unit;        // of what the expression gives, as in the key: reference_mm has "mm"
  std::string where;       // "map.toml:12"
};

struct CourseSettings {
  std::string kind = "auto";    // stops | sweep | auto
  std::string files = "auto";   // series: side by side | setups: one after the other | auto
  double turn_m = 0.0;          // linear axes: the way that counts as one turn; 0: 360 mm, a degree a millimetre
  double wrap_rad = 0.0;        // the reference starts again at this angle; 0: at 360 deg if it does
  double clock_offset_s = 0.0;  // added to the clock of the second file
  std::string phase = "full_circle";  // of all readings
  int axis_number = 0;          // of several in a file, counted from 1; 0: the first
};

struct AverageSettings {
  int most_readings = 0;  // longer recordings are averaged in blocks; 0: 20000 where two quantities are compared, else none is
};

/// A quantity that formulas need and files give under many names: in a column, or in a line of text above its rows.
struct Sought {
  std::string name;                    // as formulas have it, with its unit: "angle_deg"
  // value: another in most rows | condition: holds for many rows, also in a line | any | turn: a way round | pulse: high in a few rows of each turn |
  // column: either, in a column only, where it has no unit a word too
  std::string kind = "value";
  std::vector<std::string> words;      // what it is called, in small letters, the clearest first
  std::vector<std::string> otherwise;  // where it is not found: the first formula of which every name is known
  std::string note;                    // what is said then, if that is a number; {}: the value
  double most = 0.0;                   // a column whose values are usually larger is something else; 0: any
};

struct Map {
  std::string name;  // of the file or the ready map, for messages; empty: none was given
  std::string title;
  std::string bench;  // empty: found by the columns
  Layout file;
  ClockSettings clock;
  std::vector<MappedColumn> columns;
  CourseSettings course;
  AverageSettings average;
  std::vector<Sought> sought;
  std::vector<std::string> guess_by;  // lists of names that are sought: a file that has the columns of one is of this kind
  std::string guess_begins;           // a file that begins so is of this kind; empty: none
  std::string guess_clock = "any";    // any | none
  std::string guess_only;             // formula of quantities sought that gives a number of such a file; empty: any
  std::string leaves_out;             // rows that only(a, b) in its columns leaves out, in words
  std::vector<std::string> set;       // keys of the scenario, as in --set; {name}: what was found of a quantity that is sought
};

/// @param name_or_path  "" (nothing is said), the name of a ready map, or a TOML file.
/// @throws InputError with file:line for what is wrong in it; for an unknown name, the known ones.
Map LoadMap(const std::string& name_or_path);

/// @param name  For messages.
Map ParseMap(const std::string& text, const std::string& name);

/// "reference_mm=Axis 1.ActPos": one quantity said on the command line; it goes before the map's. "time_ms=[column 1]" is
/// the clock.
/// @throws InputError if that is no quantity of the map's bench.
void SetColumn(const std::string& assignment, Map& map);

/// A quantity's name without its unit: "reference" of "reference_deg".
std::string BaseOf(const std::string& column);

/// Those that come with the program, by name; read once.
const std::vector<Map>& ReadyMaps();

/// Every key of a map with its meaning, and the ready maps; for `twinbench help map`.
std::string DescribeMaps();

}  // namespace twinbench::imports
