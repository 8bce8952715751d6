#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hw_bridge/replay/recorded_calls.h"
#include "twin/core/run_record.h"

namespace twinbench::hw {

/// Whether the run's tables were looked at about every block: older versions did not, and a replay of theirs must not.
bool LooksAtEncoders(const std::string& record_folder);

/// A recorded run as a bench: it answers what it was asked then, in the order in which it was asked.
class ReplayBench : private Simulation {
 public:
  /// @throws InputError if the record is none, or was made without calls (an imported file).
  explicit ReplayBench(const std::string& record_folder);
  ~ReplayBench() override;
  RotaryBench Bench();

 private:
  ReplayBench(const std::string& record_folder, const RunRecord& record);
  CallAnswer Answer(const std::string& device, const std::string& request);
  Acquisition BlockOf(const DeviceCall& call);
  void Restart() override;
  void SetPaced(bool) override {}  // a recording takes no time

  std::string folder_;
  RecordedCalls calls_;
  std::vector<Reading> readings_;
  std::vector<RawBlock> blocks_;
  std::size_t next_reading_ = 0;
  Time now_{};
  std::unique_ptr<AskedBench> asked_;
};

}  // namespace twinbench::hw
