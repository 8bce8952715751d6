#include "twin/procedure/machine_journal.h"

namespace twinbench::procedure {

MachineJournal::MachineJournal(MachineBench inner, const std::vector<ReadingColumn>& shown, RunLog* log)
    : inner_(inner), shown_(shown), log_(log) {
  if (!log_) return;
  asked_ = std::make_unique<AskedMachine>(
      [this](const std::string& device, const std::string& request) { return AskInner(device, request); },
      [this] { return Now(); },
      AskedMachine::Parts{inner.machine.Axes(), shown, inner.indexer != nullptr, inner.simulation});
}

MachineBench MachineJournal::Bench() {
  return log_ ? asked_->Bench() : inner_;
}

void MachineJournal::BeginAttempt() {
  if (log_) Note(inner_.clock.Now(), kRunDevice, kAttemptBegins, inner_.simulation ? kOnSimulation : kOnRealBench);
}

std::string MachineJournal::AskInner(const std::string& device, const std::string& request) {
  std::string answer = Perform(inner_, shown_, device, request);
  Note(inner_.clock.Now(), device, request, answer);
  return answer;
}

/// A simulated clock shows what it showed at the end of the last call. A real one goes on, and where it is looked at the way
/// may depend on it.
Time MachineJournal::Now() {
  const Time now = inner_.clock.Now();
  if (now != noted_) Note(now, kClockDevice, kClockShows, "");
  return now;
}

void MachineJournal::Note(Time time, const std::string& device, const std::string& request, const std::string& answer) {
  log_->Called({time, device, request, answer});
  noted_ = time;
}

}  // namespace twinbench::procedure
