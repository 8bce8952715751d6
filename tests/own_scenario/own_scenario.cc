#include "tests/own_scenario/own_scenario.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <iostream>
#include <set>

#include "tests/support/angle_benches.h"
#include "tests/support/night.h"
#include "tests/support/thresholds.h"
#include "twin/benches/registry.h"
#include "twin/core/scenario_schema.h"
#include "twin/diagnose/diagnose.h"

namespace twinbench::test {
namespace {

constexpr int kNullRuns = 100;  // enough for a threshold, and what a scan takes at once

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
    options.cache_folder = ThresholdsFolder();
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

/// A flag or a word may switch off what other keys say.
bool IsTriedAlone(const OwnKey& key) {
  const std::string value = key.settings.back().substr(key.settings.back().find('=') + 1);
  return value == "true" || value == "false" || value.find('"') != std::string::npos;
}

std::vector<std::string> Needed(const OwnKey& key) {
  return {key.settings.begin(), key.settings.end() - 1};
}

/// Neighbours that need the same beside them are tried in one run.
std::vector<std::vector<OwnKey>> Grouped(const std::vector<OwnKey>& keys) {
  const std::size_t together = test::IsNight() ? 1 : 10;
  std::vector<std::vector<OwnKey>> groups;
  for (const OwnKey& key : keys) {
    if (key.settings.empty()) continue;
    const bool joins = !groups.empty() && groups.back().size() < together && !IsTriedAlone(key) &&
                       !IsTriedAlone(groups.back().front()) && Needed(groups.back().front()) == Needed(key);
    if (!joins) groups.emplace_back();
    groups.back().push_back(key);
  }
  return groups;
}

Alarms AlarmsTogether(const std::string& base, std::vector<std::string> settings, const std::vector<OwnKey>& keys,
                      int seeds) {
  std::vector<std::string> stated;
  for (const OwnKey& key : keys) stated.insert(stated.end(), key.settings.begin(), key.settings.end());
  settings.insert(settings.end(), stated.begin(), stated.end());
  Alarms alarms;
  Try(LoadScenario(base, settings), fmt::format("{}", fmt::join(stated, " ")), seeds, alarms);
  return alarms;
}

void Add(const Alarms& more, Alarms& alarms) {
  alarms.runs += more.runs;
  alarms.raised.insert(alarms.raised.end(), more.raised.begin(), more.raised.end());
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
  for (const std::vector<OwnKey>& group : Grouped(keys)) {
    Add(AlarmsTogether(base, base_settings, group, seeds), alarms);
    alarms.runs += static_cast<int>(group.size() - 1) * seeds;
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
  return ByNight(4, 1);
}

}  // namespace twinbench::test
