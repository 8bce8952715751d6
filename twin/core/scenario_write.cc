#include <fmt/format.h>

#include <cmath>

#include "twin/core/bench_format.h"
#include "twin/core/effect_catalogue.h"
#include "twin/core/errors.h"
#include "twin/core/number_text.h"
#include "twin/core/scenario.h"
#include "twin/core/scenario_explained.h"
#include "twin/core/scenario_schema.h"
#include "twin/core/scenario_uncertainty.h"
#include "twin/core/scenario_values.h"
#include "twin/core/signal_effect.h"

namespace twinbench {
namespace {

/// A TOML number with a point or an exponent, so that it stays one of floating point (and -0 keeps its sign).
std::string Float(double value_SI, double to_SI) {
  const std::string text = PrintInUnit(value_SI, to_SI);
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

std::string Quoted(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    const bool control = static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
    if (control) {
      quoted += fmt::format("\\u{:04x}", static_cast<int>(c));
    } else {
      quoted += (c == '"' || c == '\\') ? std::string("\\") + c : std::string(1, c);
    }
  }
  return quoted + '"';
}

/// `[a, b, c]`, each entry printed by `print`.
template <class List, class Print>
std::string Bracketed(const List& list, Print print) {
  std::string text;
  for (const auto& entry : list) text += (text.empty() ? "" : ", ") + print(entry);
  return "[" + text + "]";
}

std::string Floats(std::span<const double> values_SI, double to_SI) {
  return Bracketed(values_SI, [=](double value_SI) { return Float(value_SI, to_SI); });
}

std::string PrintHarmonic(const HarmonicSettings& h) {
  const bool angle = IsAngle(h.component);
  return fmt::format("  {{ component = \"{}\", order = {}, amplitude_{} = {}, phase_deg = {} }},\n",
                     kComponentNames[static_cast<std::size_t>(h.component)], Float(h.order, 1.0),
                     angle ? "arcsec" : "um", Float(h.amplitude, angle ? units::arcsec : units::um),
                     Float(h.phase_rad, units::deg));
}

/// Prints the value of a key: one overload a type.
struct ValuePrinter {
  const ScenarioKey& key;

  std::string operator()(const double* field) const { return Float(*field, key.unit.to_SI); }
  std::string operator()(const int* field) const { return fmt::format("{}", *field); }
  std::string operator()(const std::uint64_t* field) const {
    const bool fits = *field <= static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
    return fits ? fmt::format("{}", *field) : fmt::format("\"{}\"", *field);
  }
  std::string operator()(const bool* field) const { return *field ? "true" : "false"; }
  std::string operator()(const std::string* field) const { return Quoted(*field); }
  std::string operator()(std::span<double> field) const { return Floats(field, key.unit.to_SI); }
  std::string operator()(const std::vector<double>* field) const { return Floats(*field, key.unit.to_SI); }
  std::string operator()(const std::vector<int>* field) const {
    return Bracketed(*field, [](int number) { return fmt::format("{}", number); });
  }
  std::string operator()(const std::vector<std::string>* field) const { return Bracketed(*field, Quoted); }
  std::string operator()(const std::vector<HarmonicSettings>* field) const {
    std::string text;
    for (const HarmonicSettings& harmonic : *field) text += PrintHarmonic(harmonic);
    return text.empty() ? "[]" : "[\n" + text + "]";
  }
  std::string operator()(const std::optional<TableErrors>*) const { return ""; }        // has a table of its own
  std::string operator()(const std::optional<CompensationTable>*) const { return ""; }  // likewise
  std::string operator()(const RecordList& list) const {
    std::string text;
    for (std::size_t i = 0; i < list.size(); ++i) {
      std::string inside;
      for (const ScenarioKey& inner : list.keys_of(i))
        inside += fmt::format("{}{} = {}", inside.empty() ? "" : ", ", inner.Name(),
                              std::visit(ValuePrinter{inner}, inner.field));
      text += fmt::format("  {{ {} }},\n", inside);
    }
    return "[\n" + text + "]";
  }
};

std::string PrintColumn(const ErrorColumn& column, const std::vector<double>& values) {
  return fmt::format("{} = {}\n", column.name, Floats(values, column.to_SI));
}

std::string PrintErrors(const std::string& table, const TableErrors& errors) {
  std::string text = fmt::format("\n[{}]\n{}", table, PrintColumn(PositionColumn(), errors.position_rad));
  for (int c = 0; c < kComponents; ++c) {
    const auto component = static_cast<Component>(c);
    text += PrintColumn(ColumnOf(component), errors[component]);
  }
  return text;
}

std::string PrintCompensation(const std::string& table, const CompensationTable& compensation) {
  return fmt::format("\n[{}]\n{}{}", table, PrintColumn(PositionColumn(), compensation.position_rad),
                     PrintColumn({kCompensationCorrection, units::arcsec}, compensation.correction_rad));
}

std::string PrintKey(const ScenarioKey& key) {
  if (const auto* const* errors = std::get_if<std::optional<TableErrors>*>(&key.field))
    return (*errors)->has_value() ? PrintErrors(key.Path(), ***errors) : "";
  if (const auto* const* compensation = std::get_if<std::optional<CompensationTable>*>(&key.field))
    return (*compensation)->has_value() ? PrintCompensation(key.Path(), ***compensation) : "";
  return fmt::format("{} = {}\n", key.Name(), std::visit(ValuePrinter{key}, key.field));
}

std::string PrintFixture(FixtureSettings fixture) {
  std::string text = "\n[[fixture]]\n";
  for (const ScenarioKey& key : KeysOf(fixture)) {
    const bool of_a_mesh = key.name == "mesh_file" || key.name == "mesh_unit";
    if (fixture.mesh_file.empty() ? of_a_mesh : key.name == "box") continue;
    text += PrintKey(key);
  }
  return text;
}

std::string PrintEmpirical(EmpiricalSettings empirical) {
  std::string text = "\n[[empirical]]\n";
  for (const ScenarioKey& key : KeysOf(empirical)) {
    const auto* const* values = std::get_if<std::vector<double>*>(&key.field);
    const auto* const* readings = std::get_if<std::vector<int>*>(&key.field);
    const bool is_left_out = (values && (*values)->empty()) || (readings && (*readings)->empty());
    if (!is_left_out) text += PrintKey(key);
  }
  return text;
}

std::string PrintFinding(const EffectFinding& finding, const EffectEntry& entry) {
  std::string text;
  for (const EffectParameter& p : entry.parameters) {
    if (const auto u = finding.u.find(p.name); u != finding.u.end())
      text += fmt::format("{} = {}\n", p.UncertaintyKey(), Float(u->second, p.to_SI));
  }
  if (!std::isnan(finding.log_evidence))
    text += fmt::format("log_evidence = {}\n", Float(finding.log_evidence, 1.0));
  if (!std::isnan(finding.probability)) text += fmt::format("probability = {}\n", Float(finding.probability, 1.0));
  if (!finding.provenance.empty()) text += fmt::format("provenance = {}\n", Quoted(finding.provenance));
  return text;
}

std::string PrintEffect(const EffectSettings& effect, const std::string& bench) {
  const EffectEntry entry = EntryOf(effect, bench);
  std::string text = fmt::format("\n[[effect]]\nname = {}\n", Quoted(effect.name));
  const auto word = [&text](const char* key, const std::string& value) {
    if (!value.empty()) text += fmt::format("{} = {}\n", key, Quoted(value));
  };
  word(effect.name == kSignalEffect ? "point" : "where", effect.where);
  word("signal", effect.signal);
  word("by", effect.by);
  word("times", effect.times);
  for (const EffectParameter& parameter : entry.parameters) {
    const auto value = effect.parameters.find(parameter.name);
    if (value == effect.parameters.end() || !parameter.BelongsTo(effect.where)) continue;
    text += fmt::format("{} = {}\n", parameter.Key(), Float(value->second, parameter.to_SI));
  }
  return text + PrintFinding(effect.finding, entry);
}

/// Tables of numbers have files of their own: such a key is not written out.
bool HasOwnTable(const ScenarioKey& key) {
  return std::holds_alternative<std::optional<TableErrors>*>(key.field) ||
         std::holds_alternative<std::optional<CompensationTable>*>(key.field);
}

/// Every line behind a #, so that taking it away is all there is to do.
std::string CommentedOut(const std::string& lines) {
  std::string text;
  bool at_begin = true;
  for (const char c : lines) {
    if (at_begin) text += '#';
    text += c;
    at_begin = c == '\n';
  }
  return text;
}

std::string ExplainKey(const ScenarioKey& key) {
  const std::string what = fmt::format("# {}; {}\n", key.meaning, Expected(key));
  return what + (key.name == "bench" ? PrintKey(key) : CommentedOut(PrintKey(key)));
}

std::string NameEffects(const BenchFormat& bench) {
  std::string text =
      "\n# What can be hidden in the bench; twinbench explain NAME says what each does. A block looks like this:\n"
      "#[[effect]]\n";
  const EffectEntry& first = bench.effects.front();
  text += fmt::format("#name = \"{}\"\n", first.name);
  if (!first.places.empty()) text += fmt::format("#where = \"{}\"\n", first.places.front());
  for (const EffectEntry& effect : bench.effects) text += fmt::format("# {}: {}\n", effect.name, effect.title);
  return text;
}

}  // namespace

std::string WriteExplained(const std::string& bench) {
  const BenchFormat& format = FormatOf(bench);
  Scenario defaults;
  defaults.bench = bench;
  std::string text = fmt::format(
      "# A scenario of the bench {}: {}.\n"
      "# Every key stands here with its default, its meaning and its bounds. Take a # away to change one.\n\n",
      format.name, format.title);
  std::string table;
  for (const ScenarioKey& key : KeysOf(defaults)) {
    if (HasOwnTable(key)) continue;
    if (key.table != table) text += fmt::format("\n[{}]\n", key.table);
    table = key.table;
    text += ExplainKey(key);
  }
  return format.effects.empty() ? text : text + NameEffects(format);
}

std::string WriteScenario(const Scenario& scenario) {
  Scenario copy = scenario;  // the description binds to a scenario that may be changed
  std::string text, table;
  for (const ScenarioKey& key : KeysOf(copy)) {
    const bool own_table = HasOwnTable(key);
    if (!own_table && key.table != table) text += fmt::format("\n[{}]\n", key.table);
    if (!own_table) table = key.table;
    text += PrintKey(key) + PrintUncertainty(key, scenario.uncertainties);
  }
  for (const FixtureSettings& fixture : scenario.fixtures) text += PrintFixture(fixture);
  for (const EffectSettings& effect : scenario.effects) text += PrintEffect(effect, scenario.bench);
  for (const EmpiricalSettings& empirical : scenario.empiricals) text += PrintEmpirical(empirical);
  return text;
}

}  // namespace twinbench
