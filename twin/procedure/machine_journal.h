#pragma once

#include <memory>

#include "twin/core/machine.h"
#include "twin/core/run_log.h"

namespace twinbench::procedure {

/// The devices of a machine bench; what moves, reads, waits or mounts is written down once it has been done. Looks
/// at the controller are not.
class MachineJournal {
 public:
  /// @param log  None: nothing is written down, and the bench is used as it is.
  MachineJournal(MachineBench inner, RunLog* log);
  ~MachineJournal();
  MachineBench Bench();

 private:
  struct Devices;
  MachineBench inner_;
  std::unique_ptr<Devices> devices_;
};

}  // namespace twinbench::procedure
