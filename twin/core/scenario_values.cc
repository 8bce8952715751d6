#include "twin/core/scenario_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "twin/core/errors.h"
#include "twin/core/number_text.h"
#include "twin/core/unit_text.h"

namespace twinbench {
namespace {

[[noreturn]] void Refuse(const TomlValue& value, const std::string& key, const std::string& expected) {
  throw InputError(value.Where(), fmt::format("{} is {}", key, value.Found()), expected);
}

std::string ExpectedNumber(const Unit& unit, const Bounds& bounds) {
  return fmt::format("a number{}{}", unit.suffix.empty() ? "" : " of " + UnitInPrint(unit.suffix), bounds.Text());
}

std::string ExpectedWholeNumber(const Bounds& bounds) {
  return "a whole number" + bounds.Text();
}

long long ReadWholeNumber(const TomlValue& value, const std::string& key, const Bounds& bounds) {
  const auto number = value.node().value_exact<std::int64_t>();
  if (!number || !bounds.Contain(static_cast<double>(*number))) Refuse(value, key, ExpectedWholeNumber(bounds));
  return *number;
}

const toml::array& ReadList(const TomlValue& value, const std::string& key, const std::string& expected) {
  const toml::array* list = value.node().as_array();
  if (!list) Refuse(value, key, expected);
  if (list->empty()) throw InputError(value.Where(), key + " is empty", expected);
  return *list;
}

/// Reads every entry of a list with `read(entry)`.
template <class Number, class Read>
std::vector<Number> ReadAll(const TomlValue& value, const std::string& key, const std::string& expected,
                            Read read) {
  std::vector<Number> entries;
  for (const toml::node& node : ReadList(value, key, expected)) entries.push_back(read(value.With(node)));
  return entries;
}

std::vector<double> ReadNumbers(const TomlValue& value, const std::string& key, const Unit& unit,
                                const Bounds& bounds, const std::string& expected) {
  return ReadAll<double>(value, key, expected,
                         [&](const TomlValue& entry) { return ReadNumber(entry, key, unit, bounds); });
}

template <class Index>
Index IndexOf(const std::vector<std::string>& names, const std::string& name) {
  return static_cast<Index>(std::find(names.begin(), names.end(), name) - names.begin());
}

std::vector<std::string> ComponentNames() {
  return {kComponentNames.begin(), kComponentNames.end()};
}

TomlValue Demand(const TomlValue& table, const std::string& key, const std::string& what,
                 const std::string& expected) {
  if (const auto value = Inside(table, key)) return *value;
  throw InputError(table.Where(), fmt::format("{} has no {}", what, key), expected);
}

constexpr const char* kHarmonicForm = "{ component = \"ez\", order = 1, amplitude_arcsec = 5.0, phase_deg = 30.0 }";

/// One entry of `harmonics`; of ez if no component is named. ex, ey, ez have an amplitude_arcsec, dx, dy, dz an
/// amplitude_um.
HarmonicSettings ReadHarmonic(const TomlValue& entry, const std::string& key) {
  if (!entry.node().is_table()) Refuse(entry, key, kHarmonicForm);
  RefuseUnknown(entry, "", HarmonicKeys());
  HarmonicSettings harmonic;
  if (const auto component = Inside(entry, "component"))
    harmonic.component = IndexOf<Component>(ComponentNames(), ReadText(*component, "component", ComponentNames()));
  harmonic.order = ReadNumber(Demand(entry, "order", key, kHarmonicForm), "order", {}, {0, 100000});
  const bool angle = IsAngle(harmonic.component);
  const Unit unit = angle ? Unit{"arcsec", units::arcsec} : Unit{"um", units::um};
  const std::string amplitude = angle ? "amplitude_arcsec" : "amplitude_um";
  if (const auto other = Inside(entry, angle ? "amplitude_um" : "amplitude_arcsec"))
    throw InputError(other->Where(),
                     fmt::format("\"{}\" has an amplitude of the wrong unit",
                                 kComponentNames[static_cast<std::size_t>(harmonic.component)]),
                     amplitude);
  harmonic.amplitude = ReadNumber(Demand(entry, amplitude, key, kHarmonicForm), amplitude, unit, {-1e6, 1e6});
  if (const auto phase = Inside(entry, "phase_deg"))
    harmonic.phase_rad = ReadNumber(*phase, "phase_deg", {"deg", units::deg}, {-36000, 36000});
  return harmonic;
}

std::vector<HarmonicSettings> ReadHarmonics(const TomlValue& value, const std::string& key) {
  const toml::array* list = value.node().as_array();
  if (!list) Refuse(value, key, fmt::format("a list of {}", kHarmonicForm));
  std::vector<HarmonicSettings> harmonics;
  for (const toml::node& node : *list) harmonics.push_back(ReadHarmonic(value.With(node), key));
  return harmonics;
}

std::vector<double> ReadErrorColumn(const TomlValue& table, const std::string& key, const ErrorColumn& column,
                                    std::size_t length) {
  const auto value = Inside(table, column.name);
  if (!value) return std::vector<double>(length, 0.0);
  const std::string path = key + "." + column.name;
  const auto numbers = ReadNumbers(*value, path, {"", column.to_SI}, {}, "a list of numbers");
  if (length > 0 && numbers.size() != length)
    throw InputError(value->Where(), fmt::format("{} has {} entries", path, numbers.size()),
                     fmt::format("{}, one a position", length));
  return numbers;
}

TableErrors ReadErrors(const TomlValue& table, const std::string& key) {
  if (!table.node().is_table()) Refuse(table, key, "a table of position_deg and columns like ex_arcsec");
  RefuseUnknown(table, key, ErrorsKeys(key));
  TableErrors errors;
  Demand(table, PositionColumn().name, key, "the angle of every value");
  errors.position_rad = ReadErrorColumn(table, key, PositionColumn(), 0);
  for (int c = 0; c < kComponents; ++c) {
    const auto component = static_cast<Component>(c);
    errors[component] = ReadErrorColumn(table, key, ColumnOf(component), errors.position_rad.size());
  }
  return errors;
}

CompensationTable ReadCompensation(const TomlValue& table, const std::string& key) {
  const std::string form = fmt::format("a table of {} and {}", kCompensationPosition, kCompensationCorrection);
  if (!table.node().is_table()) Refuse(table, key, form);
  RefuseUnknown(table, key, CompensationKeys(key));
  const ErrorColumn correction{kCompensationCorrection, units::arcsec};
  for (const char* column : {kCompensationPosition, kCompensationCorrection}) Demand(table, column, key, form);
  CompensationTable compensation;
  compensation.position_rad = ReadErrorColumn(table, key, PositionColumn(), 0);
  compensation.correction_rad = ReadErrorColumn(table, key, correction, compensation.position_rad.size());
  RequireOneTurn(compensation, table.Where());
  return compensation;
}

/// Reads a value into the place that a key is bound to: one overload a type.
struct FieldReader {
  const ScenarioKey& key;
  const TomlValue& value;

  void operator()(double* field) const { *field = ReadNumber(value, key.Path(), key.unit, key.bounds); }
  void operator()(int* field) const { *field = static_cast<int>(ReadWholeNumber(value, key.Path(), key.bounds)); }
  void operator()(std::uint64_t* field) const;
  void operator()(bool* field) const {
    const auto flag = value.node().value_exact<bool>();
    if (!flag) Refuse(value, key.Path(), Expected(key));
    *field = *flag;
  }
  void operator()(std::string* field) const { *field = ReadText(value, key.Path(), key.choices); }
  void operator()(std::span<double> field) const {
    const auto numbers = ReadNumbers(value, key.Path(), key.unit, key.bounds, Expected(key));
    if (numbers.size() != field.size())
      throw InputError(value.Where(), fmt::format("{} has {} entries", key.Path(), numbers.size()), Expected(key));
    std::copy(numbers.begin(), numbers.end(), field.begin());
  }
  void operator()(std::vector<double>* field) const {
    *field = ReadNumbers(value, key.Path(), key.unit, key.bounds, Expected(key));
  }
  void operator()(std::vector<int>* field) const {
    *field = ReadAll<int>(value, key.Path(), Expected(key), [&](const TomlValue& entry) {
      return static_cast<int>(ReadWholeNumber(entry, key.Path(), key.bounds));
    });
  }
  void operator()(std::vector<std::string>* field) const {
    *field = ReadAll<std::string>(value, key.Path(), Expected(key),
                                  [&](const TomlValue& entry) { return ReadText(entry, key.Path(), key.choices); });
  }
  void operator()(std::vector<HarmonicSettings>* field) const { *field = ReadHarmonics(value, key.Path()); }
  void operator()(std::optional<TableErrors>* field) const { *field = ReadErrors(value, key.Path()); }
  void operator()(std::optional<CompensationTable>* field) const { *field = ReadCompensation(value, key.Path()); }
  void operator()(const RecordList& list) const;
};

/// TOML has no whole numbers above 2^63 - 1: a larger seed is a text of digits.
void FieldReader::operator()(std::uint64_t* field) const {
  if (const auto number = value.node().value_exact<std::int64_t>(); number && *number >= 0) {
    *field = static_cast<std::uint64_t>(*number);
    return;
  }
  const auto text = value.node().value_exact<std::string>();
  const auto seed = text ? ParseSeed(*text) : std::nullopt;
  if (!seed) Refuse(value, key.Path(), Expected(key));
  *field = *seed;
}

void FieldReader::operator()(const RecordList& list) const {
  const toml::array& entries = ReadList(value, key.Path(), Expected(key));
  list.start_anew(entries.size());
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const TomlValue entry = value.With(*entries.get(i));
    if (!entry.node().is_table()) Refuse(entry, key.Path(), Expected(key));
    ReadKeys(list.keys_of(i), entry, "");
  }
}

/// Says what a place takes: one overload a type.
struct FieldText {
  const ScenarioKey& key;

  std::string operator()(const double*) const { return ExpectedNumber(key.unit, key.bounds); }
  std::string operator()(const int*) const { return ExpectedWholeNumber(key.bounds); }
  std::string operator()(const std::uint64_t*) const { return "a whole number, 0 or more"; }
  std::string operator()(const bool*) const { return "true or false"; }
  std::string operator()(const std::string*) const { return Text("a text in quotes"); }
  std::string operator()(std::span<double> field) const {
    return fmt::format("a list of {}, each {}", field.size(), ExpectedNumber(key.unit, key.bounds));
  }
  std::string operator()(const std::vector<double>*) const {
    return "a list, each " + ExpectedNumber(key.unit, key.bounds);
  }
  std::string operator()(const std::vector<int>*) const {
    return "a list, each " + ExpectedWholeNumber(key.bounds);
  }
  std::string operator()(const std::vector<std::string>*) const { return "a list, each " + Text("a text"); }
  std::string operator()(const std::vector<HarmonicSettings>*) const {
    return fmt::format("a list of {}", kHarmonicForm);
  }
  std::string operator()(const std::optional<TableErrors>*) const { return "a table of lists"; }
  std::string operator()(const std::optional<CompensationTable>*) const { return "a table of two lists"; }
  std::string operator()(const RecordList& list) const {
    std::string names;
    for (const ScenarioKey& inner : list.example_keys())
      names += fmt::format("{}{} ({})", names.empty() ? "" : ", ", inner.Name(), Expected(inner));
    return "a list of tables with " + names;
  }

  std::string Text(const std::string& any) const { return key.choices.empty() ? any : Alternatives(key.choices); }
};

}  // namespace

std::optional<TomlValue> Inside(const TomlValue& table, const std::string& key) {
  const toml::node* node = table.node().as_table()->get(key);
  if (!node) return std::nullopt;
  return table.With(*node);
}

std::vector<KnownKey> KnownKeys(const std::vector<ScenarioKey>& keys) {
  std::vector<KnownKey> known;
  for (const ScenarioKey& key : keys) known.push_back({key.table, key.name, std::string(key.unit.suffix)});
  return known;
}

void RefuseUnknown(const TomlValue& table, const std::string& path, const std::vector<KnownKey>& known) {
  for (const auto& [key, node] : *table.node().as_table()) {
    const std::string name(key.str());
    const bool is_known = std::any_of(known.begin(), known.end(), [&](const auto& k) { return k.Key() == name; });
    if (!is_known) throw UnknownKey(table.With(node).Where(), path, name, known);
  }
}

double ReadNumber(const TomlValue& value, const std::string& key, const Unit& unit, const Bounds& bounds) {
  const std::string expected = ExpectedNumber(unit, bounds);
  const std::string text = value.NumberText(key, expected);
  if (!bounds.Contain(ParseNumber(text).value())) Refuse(value, key, expected);
  return ParseInUnit(text, unit.to_SI).value();
}

std::string ReadText(const TomlValue& value, const std::string& key, const std::vector<std::string>& choices) {
  const auto text = value.node().value_exact<std::string>();
  const std::string expected = choices.empty() ? "a text in quotes" : Alternatives(choices);
  if (!text) Refuse(value, key, expected);
  if (!choices.empty() && std::find(choices.begin(), choices.end(), *text) == choices.end())
    Refuse(value, key, expected);
  return *text;
}

void ReadKey(const ScenarioKey& key, const TomlValue& value) {
  std::visit(FieldReader{key, value}, key.field);
}

void ReadKeys(const std::vector<ScenarioKey>& keys, const TomlValue& table, const std::string& path) {
  RefuseUnknown(table, path, KnownKeys(keys));
  for (const ScenarioKey& key : keys) {
    if (const auto value = Inside(table, key.Name())) ReadKey(key, *value);
  }
}

std::string Expected(const ScenarioKey& key) {
  return std::visit(FieldText{key}, key.field);
}

std::vector<KnownKey> HarmonicKeys() {
  return {{"", "component", ""},
          {"", "order", ""},
          {"", "amplitude", "arcsec"},
          {"", "amplitude", "um"},
          {"", "phase", "deg"}};
}

std::vector<KnownKey> ErrorsKeys(const std::string& table) {
  std::vector<KnownKey> keys = {{table, "position", "deg"}};
  for (int c = 0; c < kComponents; ++c) {
    const bool angle = IsAngle(static_cast<Component>(c));
    keys.push_back({table, kComponentNames[static_cast<std::size_t>(c)], angle ? "arcsec" : "um"});
  }
  return keys;
}

std::vector<KnownKey> CompensationKeys(const std::string& table) {
  return {{table, "position", "deg"}, {table, "correction", "arcsec"}};
}

std::string Alternatives(const std::vector<std::string>& choices) {
  std::string text;
  for (std::size_t i = 0; i < choices.size(); ++i) {
    const char* separator = i == 0 ? "" : i + 1 == choices.size() ? " or " : ", ";
    text += fmt::format("{}\"{}\"", separator, choices[i]);
  }
  return text;
}

}  // namespace twinbench
