#include "twin/import/map.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <optional>

#include "twin/core/input_text.h"
#include "twin/core/nearest_key.h"
#include "twin/core/schema_table.h"
#include "twin/core/toml_reader.h"
#include "twin/import/ready_texts.h"
#include "twin/import/text.h"

namespace twinbench::imports {
namespace {

using namespace schema;

/// Quantities of every reading that a map may give beside the bench's own.
constexpr std::array kCommon = {"setup", "pass", "direction", "position", "n_samples"};

bool IsCommon(const std::string& column) {
  return std::ranges::find(kCommon, column) != kCommon.end();
}

/// The units in which a column may be given. An angle may be a length: then the axis is linear.
std::vector<std::string> UnitsFor(const std::string& column) {
  std::vector<std::string> names;
  const auto unit = UnitAtEnd(column);
  if (!unit) return {""};
  const auto add = [&names](Dimension dimension) {
    for (const NamedUnit& known : UnitsOf(dimension)) names.emplace_back(known.name);
  };
  add(unit->dimension);
  if (unit->dimension == Dimension::kAngle) add(Dimension::kLength);
  return names;
}

/// The bench's columns that a map may fill. The reading's number and its time are the import's own business.
std::vector<std::string> ColumnsOf(const BenchFormat& bench) {
  std::vector<std::string> columns;
  for (const ReadingColumn& column : bench.columns) {
    if (column.number || IsCommon(column.name)) columns.push_back(column.name);
  }
  return columns;
}

/// One text for each key that a column may have.
struct ColumnKeys {
  std::vector<MappedColumn> entries;

  explicit ColumnKeys(const std::vector<const BenchFormat*>& benches) {
    for (const BenchFormat* bench : benches) {
      for (const std::string& column : ColumnsOf(*bench)) {
        for (const std::string& unit : UnitsFor(column)) Add({column, "", unit, ""});
      }
    }
  }
  void Add(const MappedColumn& entry) {
    const bool known = std::ranges::any_of(
        entries, [&entry](const MappedColumn& e) { return e.column == entry.column && e.unit == entry.unit; });
    if (!known) entries.push_back(entry);
  }
  static std::string Key(const MappedColumn& entry) {
    return entry.unit.empty() ? entry.column : BaseOf(entry.column) + "_" + entry.unit;
  }
};

void AddKeys(Keys& keys, Map& map, ColumnKeys& columns) {
  Table top(keys, "");
  top.Text("title", &map.title, {}, "what the map is for, one line");
  top.Text("leaves_out", &map.leaves_out, {}, "rows of which only(a, b) in its columns makes no value, as messages call them");
  top.Text("bench", &map.bench, BenchNames(), "whose readings they are; left out: found by the columns");
  Table file(keys, "file");
  file.Text("kind", &map.file.kind, {"auto", "table", "changes", "scope", "array", "cycles", "records"},
            "rows of fields | one change a line (camonitor) | TwinCAT scope | array in a program | ISO 230-2 runs "
            "| JSON");
  file.Text("separator", &map.file.separator, {"auto", "tab", "semicolon", "comma", "bar", "space"},
            "between fields");
  file.Text("decimal", &map.file.decimal, {"auto", "point", "comma"}, "the decimal mark");
  file.Text("header", &map.file.header, {}, "what the line with the names begins with");
  file.Text("section", &map.file.section, {}, "what a line begins with that opens a part; each part is a mounting");
  file.Text("moved_by", &map.file.moved_by, {},
            "what a line between the rows begins with that says by how much the readings' zero moved; their sum is column \"moved\"");
  file.Add("names", kPure, {}, &map.file.names, "of the columns, in order, where the file has none");
  file.Text("array", &map.file.array, {}, "name of the array; left out: the longest");
  Table time(keys, "time");
  time.Text("column", &map.clock.column, {}, "that has the time; left out: found by its name or its look");
  time.Text("unit", &map.clock.unit, {}, "s, ms, us, ns, min, h, epoch or filetime; left out: by name or size");
  time.Add("rate", kHz, UpTo(1e9), &map.clock.rate_Hz,
           "of rows without a time, or of a column that counts samples");
  Table course(keys, "course");
  course.Text("kind", &map.course.kind, {"auto", "stops", "sweep"}, "readings at rest, or in motion");
  course.Text("files", &map.course.files, {"auto", "series", "setups"}, "side by side, or one after the other");
  course.Add("turn", kMm, UpTo(1e7), &map.course.turn_m, "linear axes: the way that counts as one turn; 0: 360 mm");
  course.Add("wrap", kDeg, UpTo(1e7), &map.course.wrap_rad,
             "the reference starts again here; 0: at 360 if it does");
  course.Add("clock_offset", kSecond, Within(1e10), &map.course.clock_offset_s, "added to the second file's clock");
  course.Text("phase", &map.course.phase, {"full_circle", "calibration", "stability", "verification"},
              "of all readings");
  course.Add("axis_number", kPure, {0, 1000}, &map.course.axis_number, "of several axes in a file the one that is taken, counted from 1");
  Table average(keys, "average");
  average.Add(
      "most_readings", kPure, {12, 1000000}, &map.average.most_readings,
      "longer recordings are averaged in blocks (20000 where two quantities are compared, else all rows are kept)");
  top.Records(
      "sought", map.sought,
      [](Table& t, Sought& s) {
        t.Text("name", &s.name, {}, "of a quantity, with its unit, as formulas have it");
        t.Text("kind", &s.kind, {"value", "condition", "any", "turn", "column", "pulse"},
               "changes from row to row | holds for many rows | either | a way round | either, in a column only, "
               "where it has no unit a word too");
        t.Add("words", kPure, {}, &s.words, "what it is called in columns and lines of text, the clearest first");
        t.Add("otherwise", kPure, {}, &s.otherwise,
              "formulas where it is not found; the first whose names are known");
        t.Text("note", &s.note, {}, "what is said then, if that is a number");
        t.Add("most", kPure, UpTo(1e9), &s.most, "a column whose values are usually larger is something else; 0: any");
      },
      "quantities that are looked for by their names");
  Table guess(keys, "guess");
  guess.Add("by", kPure, {}, &map.guess_by,
            "lists of quantities sought, \"angle_deg, deviation_um\": a file with such columns is of this kind");
  guess.Text("begins", &map.guess_begins, {}, "how the first line begins: such a file is of this kind");
  guess.Text("only", &map.guess_only, {}, "formula of them: a file of which it gives no number is of another kind");
  guess.Text("clock", &map.guess_clock, {"any", "none"}, "none: only if it has no time");
  Table scenario(keys, "scenario");
  scenario.Add("set", kPure, {}, &map.set, "keys of the scenario, as --set has them: \"device.teeth=144\"");
  Table columns_table(keys, "columns");
  for (MappedColumn& entry : columns.entries)
    columns_table.Text(ColumnKeys::Key(entry), &entry.expression, {}, "from the file's columns");
}

std::vector<const BenchFormat*> BenchesNamed(const std::string& text, const std::string& name) {
  Map top;
  Keys keys;
  std::string any;
  ColumnKeys all(BenchFormats());
  AddKeys(keys, top, all);
  ReadToml(text, name, keys);
  if (top.bench.empty()) return BenchFormats();
  return {&FormatOf(top.bench, name)};
}

std::vector<std::string> ReadyNames() {
  std::vector<std::string> names;
  for (const Map& ready : ReadyMaps()) names.push_back(ready.name);
  return names;
}

}  // namespace

std::string BaseOf(const std::string& column) {
  const auto unit = UnitAtEnd(column);
  return unit ? column.substr(0, column.size() - unit->name.size() - 1) : column;
}

Map ParseMap(const std::string& text, const std::string& name) {
  ColumnKeys columns(BenchesNamed(text, name));
  Map map;
  map.name = name;
  Keys keys;
  AddKeys(keys, map, columns);
  const KeyPlaces places = ReadToml(text, name, keys);
  for (const MappedColumn& entry : columns.entries) {
    const auto place = places.find("columns." + ColumnKeys::Key(entry));
    if (place == places.end()) continue;
    map.columns.push_back(entry);
    map.columns.back().where = place->second;
  }
  return map;
}

const std::vector<Map>& ReadyMaps() {
  static const std::vector<Map> maps = [] {
    std::vector<Map> read;
    for (const ReadyText& ready : ReadyTexts()) read.push_back(ParseMap(ready.text, ready.name));
    return read;
  }();
  return maps;
}

Map LoadMap(const std::string& name_or_path) {
  if (name_or_path.empty()) return {};
  const auto ready = std::ranges::find(ReadyMaps(), name_or_path, &Map::name);
  if (ready != ReadyMaps().end()) return *ready;
  if (!std::ifstream(name_or_path) || std::filesystem::is_directory(name_or_path))
    throw InputError("--map " + name_or_path, "there is no such file, and no ready map of that name",
                     fmt::format("a TOML file or one of {}; the nearest is {}", fmt::join(ReadyNames(), ", "),
                                 Nearest(name_or_path, ReadyNames())));
  return ParseMap(InputText(name_or_path, "a map in TOML"), name_or_path);
}

namespace {

/// "time_ms=[column 1]", "rate_Hz=100": the clock, which is no quantity of a bench.
bool SetClock(const std::string& key, const std::string& column, Map& map) {
  if (key == "rate_Hz") {
    const auto rate_Hz = FieldNumber(column, false);
    if (!rate_Hz || !(*rate_Hz > 0.0)) throw InputError("--column rate_Hz=" + column, "no rate of rows", "a number above 0");
    map.clock.rate_Hz = *rate_Hz;
    return true;
  }
  const auto unit = UnitAtEnd(key);
  if (!unit || unit->dimension != Dimension::kTime || BaseOf(key) != "time") return false;
  const bool in_brackets = column.starts_with('[') && column.ends_with(']');
  map.clock.column = in_brackets ? column.substr(1, column.size() - 2) : column;
  map.clock.unit = unit->name;
  return true;
}

}  // namespace

namespace {

/// "radius_mm=100": a quantity that this map seeks, or, if no bench has it, a ready one where none was said.
bool SetSought(const std::string& key, const std::string& formula, bool is_of_bench, Map& map) {
  const auto unit = UnitAtEnd(key);
  const auto seeks = [&](Sought& s) {
    const auto own = UnitAtEnd(s.name);
    const bool same =
        s.name == key || (unit && own && unit->dimension == own->dimension && BaseOf(s.name) == BaseOf(key));
    if (!same) return false;
    s.words.clear();
    s.note.clear();
    s.otherwise = {unit && own ? fmt::format("({}) * {:.17g}", formula, unit->to_SI / own->to_SI) : formula};
    return true;
  };
  if (std::ranges::any_of(map.sought, seeks)) return true;
  if (is_of_bench || !map.name.empty() || !map.columns.empty()) return false;
  for (Map other : ReadyMaps()) {
    if (!std::ranges::any_of(other.sought, seeks)) continue;
    map = std::move(other);
    return true;
  }
  return false;
}

}  // namespace

void SetColumn(const std::string& assignment, Map& map) {
  const std::string where = "--column " + assignment;
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos)
    throw InputError(where, "there is no =", "QUANTITY=COLUMN, as in reference_deg=angle");
  const std::string key = assignment.substr(0, equals);
  const std::string formula = assignment.substr(equals + 1);
  const ColumnKeys columns(map.bench.empty() ? BenchFormats() : std::vector{&FormatOf(map.bench)});
  const auto found =
      std::ranges::find_if(columns.entries, [&key](const MappedColumn& e) { return ColumnKeys::Key(e) == key; });
  if (SetClock(key, formula, map) || SetSought(key, formula, found != columns.entries.end(), map)) return;
  if (found == columns.entries.end()) {
    std::vector<std::string> known = {"time_s"};
    for (const MappedColumn& entry : columns.entries) known.push_back(ColumnKeys::Key(entry));
    throw InputError(where, "no bench has a quantity " + key,
                     fmt::format("another; the nearest is {}", Nearest(key, known)));
  }
  std::erase_if(map.columns, [&found](const MappedColumn& e) { return e.column == found->column; });
  map.columns.push_back(*found);
  map.columns.back().expression = formula;
  map.columns.back().where = where;
}

std::string DescribeMaps() {
  std::string text = "A map says what a file does not (docs/import.md). Ready maps:\n\n";
  for (const Map& ready : ReadyMaps()) text += fmt::format("  {:<18} {}\n", ready.name, ready.title);
  Map map;
  ColumnKeys none({});
  Keys keys;
  AddKeys(keys, map, none);
  text += "\nKeys of a map:\n\n" + DescribeKeys(keys);
  return text +
         "\n[columns]\n  a quantity of the bench with the unit in which it is given, e.g.\n"
         "  reference_deg = \"[Axis 1.ActPos]\"   measured_mm = \"counts * 0.001\"\n";
}

}  // namespace twinbench::imports
