#pragma once

#include "twin/core/reading.h"
#include "twin/core/scenario.h"

/// Runs of the twin that are diagnosed against their own scenario: whatever it states, nothing is wrong.
namespace twinbench::test {

/// One key of the schema set to a value that moves the readings, or the reason why no value can matter.
struct OwnKey {
  std::string key;
  std::vector<std::string> settings;  // as for --set: the key, and what it needs beside it
  std::string reason = {};
};

/// Keys of the bench's schema that are in no entry, and keys of entries that are in no schema.
std::vector<std::string> Forgotten(const std::string& bench, const std::vector<OwnKey>& keys);

/// A bench with its keys, and what a run of each has besides.
struct OwnBench {
  std::string name, scenario;     // in scenarios/
  std::vector<std::string> base = {};  // settings that every run has
  std::vector<OwnKey> keys = {};
  std::vector<std::string> effects_base = {};  // ... and those with an effect
  int effects_an_alarm = 20;                   // an alarm in so many of its effects is not too much
};
const std::vector<OwnBench>& OwnBenches();

/// A run to be made and diagnosed with its own scenario.
struct OwnRun {
  std::string what = {};  // the settings or the effects
  Scenario scenario;
  int stated = 1;  // so many keys or effects: those that need the same beside them share a run
};
/// @param together  So many share a run at the most.
std::vector<OwnRun> KeyRuns(const OwnBench& bench, std::size_t together);
/// Every effect of the catalogue at its default size.
std::vector<OwnRun> EffectRuns(const OwnBench& bench, std::size_t together);

/// What the diagnosis has to say; empty if nothing.
std::string AlarmOf(const OwnRun& run);
std::string AlarmIn(const std::vector<Reading>& readings, const Scenario& scenario);

}  // namespace twinbench::test
