#pragma once

#include "twin/core/run_log.h"

namespace twinbench::procedure {

/// A bench whose calls are written down before anybody sees their answers.
class Journal {
 public:
  /// @param log   None: nothing is written down, and the bench is used as it is. Text costs more than a simulated
  ///              reading does.
  /// @param done  Calls of the readings that are kept already (a resumed run).
  Journal(RotaryBench inner, RunLog* log, std::vector<DeviceCall> done);

  RotaryBench Bench() { return log_ ? asked_.Bench() : inner_; }
  bool kept() const { return log_ != nullptr; }
  RotaryBench& inner() { return inner_; }

  /// The calls since the last reading led to one; they lead there again on a simulated bench.
  void Commit();
  /// They led to nothing.
  void Forget();
  const std::vector<DeviceCall>& done() const { return done_; }

 private:
  CallAnswer AskInner(const std::string& device, const std::string& request);

  RotaryBench inner_;
  RunLog* log_;
  std::vector<DeviceCall> done_, pending_;  // kept for a simulated bench only
  AskedBench asked_;
};

}  // namespace twinbench::procedure
