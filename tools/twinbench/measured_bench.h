#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hw_bridge/bench_file.h"
#include "twin/core/devices.h"

namespace twinbench::tools {

/// The bench that a bench file names, whatever kind it is of, open until this goes.
class MeasuredBench {
 public:
  virtual ~MeasuredBench() = default;
  virtual RotaryBench Bench() = 0;
  virtual std::string Identity() const = 0;
  /// For the record: what was agreed with the A/D card before the run, what was noticed during it.
  virtual std::vector<std::string> Configuration() const { return {}; }
  virtual std::vector<std::string> Notices() const { return {}; }
};

/// @param elapsed  How long ago Time 0 of the run was.
std::unique_ptr<MeasuredBench> OpenMeasuredBench(const hw::BenchFile& file, const Scenario& scenario,
                                                 Duration elapsed);

}  // namespace twinbench::tools
