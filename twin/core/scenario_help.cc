#include <fmt/format.h>

#include "twin/core/bench_format.h"
#include "twin/core/scenario.h"
#include "twin/core/scenario_schema.h"
#include "twin/core/scenario_values.h"

namespace twinbench {
namespace {

/// For people: seven digits are enough.
std::string Short(double value_SI, double to_SI) {
  return fmt::format("{:.7g}", value_SI / to_SI);
}

std::string ShortList(std::span<const double> values_SI, double to_SI) {
  std::string text;
  for (const double value_SI : values_SI) text += (text.empty() ? "" : ", ") + Short(value_SI, to_SI);
  return "[" + text + "]";
}

/// Prints the default of a key: one overload a type.
struct DefaultText {
  const ScenarioKey& key;

  std::string operator()(const double* field) const { return Short(*field, key.unit.to_SI); }
  std::string operator()(const int* field) const { return fmt::format("{}", *field); }
  std::string operator()(const std::uint64_t* field) const { return fmt::format("{}", *field); }
  std::string operator()(const bool* field) const { return *field ? "true" : "false"; }
  std::string operator()(const std::string* field) const { return '"' + *field + '"'; }
  std::string operator()(std::span<double> field) const { return ShortList(field, key.unit.to_SI); }
  std::string operator()(const std::vector<double>* field) const { return ShortList(*field, key.unit.to_SI); }
  std::string operator()(const std::vector<int>* field) const {
    const std::vector<double> numbers(field->begin(), field->end());
    return ShortList(numbers, 1.0);
  }
  std::string operator()(const std::vector<std::string>* field) const {
    std::string text;
    for (const std::string& entry : *field) text += fmt::format("{}\"{}\"", text.empty() ? "" : ", ", entry);
    return "[" + text + "]";
  }
  std::string operator()(const std::vector<HarmonicSettings>*) const { return "[]"; }
  std::string operator()(const std::optional<TableErrors>*) const { return "none"; }
  std::string operator()(const std::optional<CompensationTable>*) const { return "none"; }
  std::string operator()(const RecordList& list) const {
    std::string text;
    for (std::size_t i = 0; i < list.size(); ++i) {
      std::string inside;
      for (const ScenarioKey& inner : list.keys_of(i))
        inside += fmt::format("{}{} = {}", inside.empty() ? "" : ", ", inner.Name(),
                              std::visit(DefaultText{inner}, inner.field));
      text += fmt::format("{}{{ {} }}", text.empty() ? "" : ", ", inside);
    }
    return "[" + text + "]";
  }
};

std::string DescribeKey(const ScenarioKey& key) {
  return fmt::format("{} = {}\n    {}; {}\n", key.Name(), std::visit(DefaultText{key}, key.field), key.meaning,
                     Expected(key));
}

std::string DescribeParameter(const EffectParameter& p) {
  const std::string places = p.only_at.empty() ? "" : fmt::format(" (at {} only)", fmt::join(p.only_at, ", "));
  return fmt::format("{} = {}\n    {}{}; a number{} from {} to {}\n", p.Key(), Short(p.default_SI, p.to_SI),
                     p.meaning, places, p.unit == "1" ? "" : " of " + p.unit, Short(p.lower_SI, p.to_SI),
                     Short(p.upper_SI, p.to_SI));
}

std::string DescribeFixture() {
  FixtureSettings example;
  example.name = "housing";
  example.box_m = Vector3::Constant(20.0 * units::mm);
  std::string text = "\n[[fixture]]  # something opaque in the way of the light: a box or a mesh\n";
  for (const ScenarioKey& key : KeysOf(example)) text += DescribeKey(key);
  return text;
}

std::string DescribeEmpirical() {
  EmpiricalSettings example;
  example.signature = "order 7 synchronous with the reference angle";
  example.channel = "psd_a_y";
  std::string text = "\n[[empirical]]  # an unmodelled effect, tabulated; a diagnosis writes it\n";
  for (const ScenarioKey& key : KeysOf(example)) text += DescribeKey(key);
  return text;
}

constexpr const char* kFinding =
    "\nIn every [[effect]] that a diagnosis has added, and without influence on the bench:\n"
    "u_PARAMETER\n    standard uncertainty of PARAMETER, in its unit\n"
    "log_evidence, probability\n    how sure the diagnosis was\n"
    "provenance\n    which run said so, and when\n";

std::string DescribeEffect(const EffectEntry& entry) {
  std::string text = fmt::format("\n[[effect]]  # {}\nname = \"{}\"\n", entry.title, entry.name);
  if (!entry.places.empty()) {
    const std::string fallback =
        entry.default_place.empty() ? "" : fmt::format("; \"{}\" if left out", entry.default_place);
    text += fmt::format("where\n    {}{}\n", Alternatives(entry.places), fallback);
  }
  for (const EffectParameter& parameter : entry.parameters) text += DescribeParameter(parameter);
  return text;
}

std::string DescribeBench(const BenchFormat& bench) {
  Scenario defaults;
  defaults.bench = bench.name;
  std::string text = fmt::format("\n# ---- bench {} ----\n", bench.name) + DescribeKeys(KeysOf(defaults));
  if (bench.has_fixtures) text += DescribeFixture();
  for (const EffectEntry& entry : bench.effects) text += DescribeEffect(entry);
  return text;
}

}  // namespace

std::string DescribeKeys(const std::vector<ScenarioKey>& keys) {
  std::string text, table;
  for (const ScenarioKey& key : keys) {
    if (key.table != table) text += fmt::format("\n[{}]\n", key.table);
    table = key.table;
    text += DescribeKey(key);
  }
  return text;
}

std::string DescribeScenarioKeys() {
  std::string text;
  for (const BenchFormat* bench : BenchFormats()) text += DescribeBench(*bench);
  return text + kFinding + DescribeEmpirical();
}

}  // namespace twinbench
