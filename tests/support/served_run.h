#pragma once

#include "tests/support/served_twin.h"
#include "twin/benches/rotary_4dof/procedure/procedure.h"

/// Runs of the real procedure on a served twin, through the real backends, with faults on the way.
namespace twinbench::test {

struct ServedRun {
  MemoryLog log;
  std::string stopped_by;  // name of the fault that ended it; empty: it was carried out
  std::string said;
  std::string Readings() const;  // as readings.csv
};

struct RunOptions {
  std::string converter = "iio";      // iio | comedi
  std::string tables = "scpi";        // scpi | esp | pty
  std::map<int, std::string> faults;  // injected when so many readings are kept
  std::function<void(hw::BenchFile&)> alter;
};

/// Why comedi cannot be tried here; empty if it can.
std::string MissingComedi();

/// The bench file that reaches a served twin; every answer is awaited for kForAnAnswer_s.
hw::BenchFile BenchFileOf(const ServedTwin& served, const RunOptions& options);

/// A run from its beginning, or going on behind what `before` has kept.
ServedRun RunServed(const ServedTwin& served, const Scenario& scenario, const RunOptions& options = {},
                    const ServedRun* before = nullptr);

/// The same scenario on the twin inside this program: readings.csv.
std::string InProcess(const Scenario& scenario);

}  // namespace twinbench::test
