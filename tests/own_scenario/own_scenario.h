#pragma once

#include <string>
#include <vector>

#include "twin/core/scenario.h"

/// Runs of the twin that are diagnosed against their own scenario: whatever it states, nothing is wrong.
namespace twinbench::test {

/// One key of the schema set to a value that moves the readings, or the reason why no value can matter.
struct OwnKey {
  std::string key;
  std::vector<std::string> settings;  // as for --set: the key, and what it needs beside it
  std::string reason = {};
};

/// A key with a value that readings feel, and what else must be so that they do.
OwnKey Change(const std::string& key, const std::string& value, std::vector<std::string> with = {});

/// Keys of the bench's schema that are in no entry, and keys of entries that are in no schema.
std::vector<std::string> Forgotten(const std::string& bench, const std::vector<OwnKey>& keys);

struct Alarms {
  int runs = 0;
  std::vector<std::string> raised;  // key = value: cause, for each
  std::string InWords() const;
};

/// Neighbours in the list share a run where they can; every key counts as one.
/// @param base    Scenario and settings that every run has.
/// @param seeds   How many of each.
Alarms AlarmsOf(const std::string& base, const std::vector<std::string>& base_settings,
                const std::vector<OwnKey>& keys, int seeds);

/// The same for every effect of the bench's catalogue at its default size.
Alarms AlarmsOfEffects(const std::string& base, const std::vector<std::string>& base_settings, int seeds);

/// One, by night several.
int Seeds();

}  // namespace twinbench::test
