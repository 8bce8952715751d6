#pragma once

#include "twin/core/device_call.h"
#include "twin/core/machine_call.h"

namespace twinbench::test {

/// A bench between which and its user somebody sits who may throw, or answer something else.
class TroubledBench {
 public:
  using Trouble = std::function<void(const std::string& device, const std::string& request, CallAnswer& answer)>;
  /// @param before  Called before the bench is asked, `after` when it has answered; either may be empty.
  TroubledBench(RotaryBench inner, Trouble before, Trouble after = {})
      : inner_(inner),
        before_(std::move(before)),
        after_(std::move(after)),
        asked_([this](const std::string& device, const std::string& request) { return Ask(device, request); },
               [this] { return inner_.clock.Now(); }, inner.simulation) {}
  RotaryBench Bench() { return asked_.Bench(); }

 private:
  CallAnswer Ask(const std::string& device, const std::string& request) {
    CallAnswer answer;
    if (before_) before_(device, request, answer);
    answer = Perform(inner_, device, request);
    if (after_) after_(device, request, answer);
    return answer;
  }

  RotaryBench inner_;
  Trouble before_, after_;
  AskedBench asked_;
};

/// A bench with a machine between which and its user somebody sits who may throw, or answer something else:
/// TroubledBench is the same for tables.
class TroubledMachine {
 public:
  using Trouble = std::function<void(const std::string& device, const std::string& request, std::string& answer)>;
  /// @param shown   InstrumentColumns of the bench.
  /// @param before  Called before the bench is asked, `after` when it has answered; either may be empty.
  TroubledMachine(MachineBench inner, const std::vector<ReadingColumn>& shown, Trouble before, Trouble after = {})
      : inner_(inner),
        shown_(shown),
        before_(std::move(before)),
        after_(std::move(after)),
        asked_([this](const std::string& device, const std::string& request) { return Ask(device, request); },
               [this] { return inner_.clock.Now(); },
               {inner.machine.Axes(), shown, inner.indexer != nullptr, inner.simulation}) {}
  MachineBench Bench() { return asked_.Bench(); }

 private:
  std::string Ask(const std::string& device, const std::string& request) {
    std::string answer;
    if (before_) before_(device, request, answer);
    answer = Perform(inner_, shown_, device, request);
    if (after_) after_(device, request, answer);
    return answer;
  }

  MachineBench inner_;
  std::vector<ReadingColumn> shown_;
  Trouble before_, after_;
  AskedMachine asked_;
};

}  // namespace twinbench::test
