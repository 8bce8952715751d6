#include "tests/own_scenario/own_scenario.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdlib>
#include <iostream>
#include <set>

#include "tests/support/angle_benches.h"
#include "twin/benches/registry.h"
#include "twin/core/scenario_schema.h"
#include "twin/diagnose/diagnose.h"

namespace twinbench::test {
namespace {

constexpr int kNullRuns = 200;  // enough for a threshold; twice as quick as by default

std::string CauseOf(const diagnose::Diagnosis& d) {
  if (d.causes.empty()) return fmt::format("unknown {}", d.unknown.signature);
  return fmt::format("{} {} {:.2f}", d.causes.front().effect, d.causes.front().where, d.causes.front().probability);
}

/// Runs the twin and asks what is wrong.
void Try(Scenario scenario, const std::string& what, int seeds, Alarms& alarms) {
  const std::uint64_t first = scenario.seed;
  for (int k = 0; k < seeds; ++k) {
    scenario.seed = first + static_cast<std::uint64_t>(k);
    diagnose::DiagnoseOptions options;
    options.null_runs = kNullRuns;
    ++alarms.runs;
    std::string raised;
    try {
      const diagnose::Diagnosis d = diagnose::Diagnose(ReadingsOf(scenario), scenario, options).diagnosis;
      if (d.verdict != diagnose::Verdict::kNone) raised = CauseOf(d);
    } catch (const std::exception& error) {
      raised = error.what();
    }
    if (raised.empty()) continue;
    alarms.raised.push_back(fmt::format("{} (seed {}): {}", what, scenario.seed, raised));
    std::cout << alarms.raised.back() << std::endl;
  }
}

}  // namespace

OwnKey Change(const std::string& key, const std::string& value, std::vector<std::string> with) {
  with.push_back(key + "=" + value);
  return {key, std::move(with)};
}

std::vector<std::string> Forgotten(const std::string& bench, const std::vector<OwnKey>& keys) {
  std::set<std::string> in_schema, listed;
  Scenario scenario;
  scenario.bench = bench;
  for (const ScenarioKey& key : KeysOf(scenario)) in_schema.insert(key.Path());
  for (const OwnKey& key : keys) listed.insert(key.key);
  std::vector<std::string> forgotten;
  std::ranges::set_symmetric_difference(in_schema, listed, std::back_inserter(forgotten));
  return forgotten;
}

std::string Alarms::InWords() const {
  return fmt::format("{} of {} runs:\n{}", raised.size(), runs, fmt::join(raised, "\n"));
}

Alarms AlarmsOf(const std::string& base, const std::vector<std::string>& base_settings,
                const std::vector<OwnKey>& keys, int seeds) {
  Alarms alarms;
  for (const OwnKey& key : keys) {
    if (key.settings.empty()) continue;
    std::vector<std::string> settings = base_settings;
    settings.insert(settings.end(), key.settings.begin(), key.settings.end());
    Try(LoadScenario(base, settings), fmt::format("{}", fmt::join(key.settings, " ")), seeds, alarms);
  }
  return alarms;
}

Alarms AlarmsOfEffects(const std::string& base, const std::vector<std::string>& base_settings, int seeds) {
  Alarms alarms;
  const Scenario plain = LoadScenario(base, base_settings);
  for (const EffectEntry& entry : EffectCatalogue(plain.bench)) {
    if (entry.name == "outliers") continue;  // which readings they meet, nobody can foresee
    Scenario scenario = plain;
    scenario.effects = {PlainEffect(entry)};
    Try(scenario, entry.name, seeds, alarms);
  }
  return alarms;
}

int Seeds() {
  const char* stated = std::getenv("OWN_SCENARIO_SEEDS");
  return stated ? std::atoi(stated) : 1;
}

}  // namespace twinbench::test
