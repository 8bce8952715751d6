#include "tests/own_scenario/own_scenario.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "tests/support/angle_benches.h"
#include "twin/benches/registry.h"
#include "twin/core/errors.h"
#include "twin/core/scenario_schema.h"
#include "twin/diagnose/diagnose.h"

namespace twinbench::test {
namespace {

constexpr int kNullRuns = 100;  // enough for a threshold, and what a scan takes at once

std::string CauseOf(const diagnose::Diagnosis& d) {
  if (d.causes.empty()) return fmt::format("unknown {}", d.unknown.signature);
  return fmt::format("{} {} {:.2f}", d.causes.front().effect, d.causes.front().where, d.causes.front().probability);
}

/// A flag or a word may switch off what other keys say.
bool IsTriedAlone(const OwnKey& key) {
  const std::string value = key.settings.back().substr(key.settings.back().find('=') + 1);
  return value == "true" || value == "false" || value.starts_with('"');
}

std::string KeyOf(const std::string& setting) {
  return setting.substr(0, setting.find('='));
}

OwnRun RunTogether(const OwnBench& bench, const std::vector<OwnKey>& keys) {
  std::vector<std::string> stated, settings = bench.base;
  for (const OwnKey& key : keys) stated.insert(stated.end(), key.settings.begin(), key.settings.end());
  settings.insert(settings.end(), stated.begin(), stated.end());
  return {fmt::format("{}", fmt::join(stated, " ")), LoadScenario(ScenarioPath(bench.scenario), settings),
          static_cast<int>(keys.size())};
}

/// Neither says another value of a key than the others say, and the bench takes all of them.
bool Joins(const OwnKey& key, std::vector<OwnKey> group, const OwnBench& bench) {
  if (IsTriedAlone(key) || IsTriedAlone(group.front())) return false;
  for (const OwnKey& one : group) {
    for (const std::string& setting : one.settings) {
      const auto same = std::ranges::find(key.settings, KeyOf(setting), KeyOf);
      if (same != key.settings.end() && *same != setting) return false;
    }
  }
  group.push_back(key);
  try {
    RunTogether(bench, group);
  } catch (const InputError&) {
    return false;
  }
  return true;
}

/// Those that say nothing against each other are tried in one run.
std::vector<std::vector<OwnKey>> Grouped(const OwnBench& bench, std::size_t together) {
  std::vector<std::vector<OwnKey>> groups;
  for (const OwnKey& key : bench.keys) {
    if (key.settings.empty()) continue;
    const auto joined = std::ranges::find_if(groups, [&](const std::vector<OwnKey>& group) {
      return group.size() < together && Joins(key, group, bench);
    });
    (joined != groups.end() ? *joined : groups.emplace_back()).push_back(key);
  }
  return groups;
}

}  // namespace

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

std::vector<OwnRun> KeyRuns(const OwnBench& bench, std::size_t together) {
  std::vector<OwnRun> runs;
  for (const std::vector<OwnKey>& group : Grouped(bench, together)) runs.push_back(RunTogether(bench, group));
  return runs;
}

std::vector<OwnRun> EffectRuns(const OwnBench& bench, std::size_t together) {
  const Scenario plain = LoadScenario(ScenarioPath(bench.scenario), bench.effects_base);
  std::vector<OwnRun> runs;
  for (const EffectEntry& entry : EffectCatalogue(plain.bench)) {
    if (entry.name == "outliers") continue;  // which readings they meet, nobody can foresee
    const bool joins = !runs.empty() && runs.back().scenario.effects.size() < together;
    if (!joins) runs.push_back({.scenario = plain, .stated = 0});
    OwnRun& run = runs.back();
    run.what += (joins ? " " : "") + entry.name;
    run.scenario.effects.push_back(PlainEffect(entry));
    ++run.stated;
  }
  return runs;
}

std::string AlarmIn(const std::vector<Reading>& readings, const Scenario& scenario, const std::string& cache_folder) {
  diagnose::DiagnoseOptions options;
  options.null_runs = kNullRuns;
  options.cache_folder = cache_folder;
  try {
    const diagnose::Diagnosis d = diagnose::Diagnose(readings, scenario, options).diagnosis;
    return d.verdict == diagnose::Verdict::kNone ? "" : CauseOf(d);
  } catch (const std::exception& error) {
    return error.what();
  }
}

std::string AlarmOf(const OwnRun& run, const std::string& cache_folder) {
  return AlarmIn(ReadingsOf(run.scenario), run.scenario, cache_folder);
}

}  // namespace twinbench::test
