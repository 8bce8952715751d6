#include "twin/investigate/hidden_run.h"

#include <algorithm>
#include <sstream>
#include <variant>

#include "twin/core/errors.h"
#include "twin/core/happened_once.h"
#include "twin/core/scenario_schema.h"

namespace twinbench::investigate {
namespace {

constexpr const char* kProcedure = "procedure";  // how the name of every such table ends
constexpr const char* kScans = "adc.samples=";   // a reading's, which the sequencer asks for

std::string TableOfSet(const std::string& set) {
  const std::string path = set.substr(0, set.find('='));
  const std::size_t dot = path.rfind('.');
  return dot == std::string::npos ? "" : path.substr(0, dot);
}

/// The procedure's keys of a scenario as overrides.
std::vector<std::string> ProcedureOf(const Scenario& scenario) {
  std::vector<std::string> sets;
  std::istringstream text(WriteScenario(scenario));
  std::string table;
  for (std::string line; std::getline(text, line);) {
    if (line.starts_with("[")) table = line.substr(1, line.find(']') - 1);
    const std::size_t equals = line.find(" = ");
    if (!table.ends_with(kProcedure) || line.starts_with("[") || line.starts_with("#") ||
        equals == std::string::npos)
      continue;
    std::string value = line.substr(equals + 3);
    if (value == "[") {  // of tables, one a line
      for (std::string entry; value.back() != ']' && std::getline(text, entry);) value += entry;
    }
    sets.push_back(table + "." + line.substr(0, equals) + "=" + value);
  }
  return sets;
}

/// Numbers outside the procedure.
std::vector<double*> NumbersOf(Scenario& scenario) {
  std::vector<double*> numbers;
  for (const ScenarioKey& key : KeysOf(scenario)) {
    double* const* number = std::get_if<double*>(&key.field);
    if (number && !key.table.ends_with(kProcedure)) numbers.push_back(*number);
  }
  return numbers;
}

bool IsNumber(Scenario& scenario, const std::string& set) {
  const std::string path = set.substr(0, set.find('='));
  const std::vector<ScenarioKey> keys = KeysOf(scenario);
  const auto key = std::ranges::find_if(keys, [&path](const ScenarioKey& k) { return k.Path() == path; });
  return key != keys.end() && std::holds_alternative<double*>(key->field);
}

}  // namespace

Scenario HiddenRun(const Scenario& hidden, const Scenario& believed, const plan::NextRun& run, int repeat) {
  if (hidden.bench != believed.bench)
    throw InputError("--twin", "is a scenario of the bench " + hidden.bench, "one of the bench " + believed.bench);
  Scenario asked = Altered(believed, run.sets), before = believed;
  std::vector<std::string> sets = ProcedureOf(asked);
  for (const std::string& set : run.sets) {
    if (!TableOfSet(set).ends_with(kProcedure) && !IsNumber(before, set)) sets.push_back(set);
  }
  Scenario made = InRun(Altered(hidden, sets), hidden.repeat + repeat - believed.repeat);
  made.repeat = repeat;
  const std::vector<double*> to = NumbersOf(made), from = NumbersOf(asked), base = NumbersOf(before);
  for (std::size_t k = 0; k < to.size(); ++k) *to[k] += *from[k] - *base[k];
  return Altered(made, {});  // refuses what has left its bounds
}

bool IsProcedureAlone(const plan::NextRun& run) {
  return std::ranges::all_of(run.sets, [](const std::string& set) {
    return TableOfSet(set).ends_with(kProcedure) || set.starts_with(kScans);
  });
}

}  // namespace twinbench::investigate
