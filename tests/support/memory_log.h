#pragma once

#include "twin/benches/names.h"
#include "twin/core/run_record.h"

namespace twinbench::test {

/// A run record in memory: readings with their calls, and what came to nothing.
class MemoryLog : public ReadingSink, public RunLog {
 public:
  void Append(const Reading& reading, const Acquisition&) override {
    readings.push_back(reading);
    calls.insert(calls.end(), pending_.begin(), pending_.end());
    pending_.clear();
  }
  void Called(const DeviceCall& call) override { pending_.push_back(call); }
  void ForgetCalls() override { pending_.clear(); }
  void AttemptFailed(int reading, Time time, const std::string& fault, const std::string& text) override {
    attempts.push_back({reading, ++attempts_at_[reading], time, fault, text});
  }
  void AppendEvent(Time time, const std::string& device, const std::string& text) override {
    events.push_back({time, device, text});
  }
  void RequireRoom() override {}

  std::vector<Reading> readings;
  std::vector<DeviceCall> calls;
  std::vector<FailedAttempt> attempts;
  std::vector<RecordedEvent> events;

 private:
  std::vector<DeviceCall> pending_;
  std::map<int, int> attempts_at_;
};

/// readings.csv: text keeps every bit of the numbers, and NaN equals NaN in it.
inline std::string TextOf(const std::vector<Reading>& readings, const std::string& bench = kRotaryBench) {
  std::ostringstream text;
  WriteReadingsCsv(readings, bench, text);
  return text.str();
}

}  // namespace twinbench::test
