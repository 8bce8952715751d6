#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tools/twinbench/live_page.h"
#include "twin/core/reading.h"
#include "twin/core/scenario.h"
#include "twin/investigate/investigation.h"

namespace twinbench::tools {

/// The bench that an investigation measures on; every run gets a folder below `folder`. A folder that holds a
/// finished run of the same scenario is not measured again, one that was begun is taken up.
class InvestigatedBench {
 public:
  virtual ~InvestigatedBench() = default;
  /// @throws InputError if the folder holds another run.
  virtual std::vector<Reading> Measure(const investigate::Step& step, const Scenario& asked) = 0;
  /// Without somebody who changes the bench or its room.
  virtual bool CanMakeAlone(const plan::NextRun& run) const = 0;
};

/// Both show their runs on `page`, which outlives them.
/// A twin that has something hidden; what `believed` says it is, it need not be.
std::unique_ptr<InvestigatedBench> OpenHiddenTwin(const std::string& hidden, const Scenario& believed,
                                                  const std::string& folder, LivePage& page);

/// What a bench file names: devices, the own twin, a program.
std::unique_ptr<InvestigatedBench> OpenMeasuredBench(const std::string& bench_file, const std::string& folder,
                                                     LivePage& page);

}  // namespace twinbench::tools
