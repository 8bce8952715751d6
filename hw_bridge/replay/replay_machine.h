#pragma once

#include <memory>
#include <string>

#include "hw_bridge/replay/recorded_calls.h"
#include "twin/core/machine_call.h"

namespace twinbench::hw {

/// A recorded run of a bench with a machine as that bench: it answers what it was asked then, in the order in which it was
/// asked. Of a simulated bench the last attempt is played, which went all the way; on a real one every attempt went on where
/// the one before had ended, and so does the replay: it ends the attempt where the recorded one ended.
class ReplayMachine : public MachineDevices, private Simulation {
 public:
  /// @param axes         Of the bench, as its twin has them.
  /// @param shown        InstrumentColumns of the bench.
  /// @param has_indexer  Whether the bench has a multi-tooth table.
  /// @throws InputError if the record is none, was made without calls (an imported file, `run`) or without their answers (by
  ///         a twinbench that did not keep them).
  ReplayMachine(const std::string& record_folder, std::vector<MachineAxis> axes, std::vector<ReadingColumn> shown,
                bool has_indexer);
  ~ReplayMachine() override;
  MachineBench Devices() override;
  /// Whether it was a simulated bench: only of such a one can a replay be resumed.
  bool IsOfSimulation() const { return is_simulation_; }
  /// How often the way was begun.
  int Attempts() const { return attempts_; }

 private:
  std::string Answer(const std::string& device, const std::string& request);
  bool AtAttempt() const;
  /// Over the mark at which an attempt begins. @throws DeviceFault kGap if the one before has not been ended yet.
  void PassAttempt();
  Time Now();
  void Restart() override;
  void SetPaced(bool) override {}  // a recording takes no time

  RecordedCalls calls_;
  bool is_simulation_ = false;
  int attempts_ = 0;
  std::size_t begin_ = 0;     // number of the call with which the replay begins
  bool may_begin_ = true;     // the next attempt
  Time now_{};
  std::unique_ptr<AskedMachine> asked_;
};

}  // namespace twinbench::hw
