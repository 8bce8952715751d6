#include "twin/procedure/journal.h"

namespace twinbench::procedure {

Journal::Journal(RotaryBench inner, RunLog* log, std::vector<DeviceCall> done)
    : inner_(inner),
      log_(log),
      done_(std::move(done)),
      asked_([this](const std::string& device, const std::string& request) { return AskInner(device, request); },
             [this] { return inner_.clock.Now(); }, inner.simulation) {}

CallAnswer Journal::AskInner(const std::string& device, const std::string& request) {
  CallAnswer answer = Perform(inner_, device, request);
  const DeviceCall call{inner_.clock.Now(), device, request, answer.text};
  log_->Called(call);
  if (inner_.simulation) pending_.push_back(call);
  return answer;
}

void Journal::Commit() {
  done_.insert(done_.end(), pending_.begin(), pending_.end());
  pending_.clear();
}

void Journal::Forget() {
  if (log_) log_->ForgetCalls();
  pending_.clear();
}

}  // namespace twinbench::procedure
