#pragma once

#include <string>
#include <vector>

#include "twin/core/scenario.h"
#include "twin/diagnose/diagnosis.h"

/// Every key of a bench's scenario, changed alone, and a run diagnosed against its own scenario: whatever the
/// scenario states must not look like something that it gets wrong.
namespace twinbench::hidden {

/// A key with a value that readings feel, and what else must be so that they do.
struct KeyChange {
  std::string key;                    // "psd_a.roll_mrad"
  std::string value;                  // TOML
  std::vector<std::string> with = {}; // further overrides
};

/// A key that has no value of its own to try, and why.
struct KeyLeftOut {
  std::string key, why;
};

const std::vector<KeyChange>& KeyChanges(const std::string& bench);
const std::vector<KeyLeftOut>& KeysLeftOut(const std::string& bench);

/// A short run of the bench, the change made.
Scenario ChangedBench(const std::string& bench, const KeyChange& change, std::uint64_t seed);

/// What the diagnosis says of a run against its own scenario.
diagnose::Diagnosis DiagnosedAgainstItself(const Scenario& scenario, const std::string& cache_folder);

}  // namespace twinbench::hidden
