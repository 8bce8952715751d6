#pragma once

#include <memory>

#include "twin/core/machine_call.h"
#include "twin/core/run_log.h"

namespace twinbench::procedure {

/// The devices of a machine bench; every call is written down with its answer before anybody sees it, so that the run can be
/// played back.
class MachineJournal {
 public:
  /// @param shown  InstrumentColumns of the bench.
  /// @param log    None: nothing is written down, and the bench is used as it is. Text costs more than a simulated reading
  ///               does.
  MachineJournal(MachineBench inner, const std::vector<ReadingColumn>& shown, RunLog* log);
  MachineBench Bench();
  /// Says that the way begins: from the start on a simulated bench, with the first reading that is missing on a real one.
  void BeginAttempt();

 private:
  std::string AskInner(const std::string& device, const std::string& request);
  Time Now();
  void Note(Time time, const std::string& device, const std::string& request, const std::string& answer);

  MachineBench inner_;
  std::vector<ReadingColumn> shown_;
  RunLog* log_;
  Time noted_{};  // of the last call in the log
  std::unique_ptr<AskedMachine> asked_;
};

}  // namespace twinbench::procedure
