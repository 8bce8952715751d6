#include "hw_bridge/replay/replay_machine.h"

#include "twin/core/device_fault.h"
#include "twin/core/nothing_moves.h"
#include "twin/core/run_record.h"

namespace twinbench::hw {
namespace {

bool BeginsAttempt(const DeviceCall& call) {
  return call.device == kRunDevice && call.request == kAttemptBegins;
}

}  // namespace

ReplayMachine::ReplayMachine(const std::string& record_folder, std::vector<MachineAxis> axes,
                             std::vector<ReadingColumn> shown, bool has_indexer)
    : calls_(record_folder, RunRecord::Open(record_folder)->Calls()) {
  if (!BeginsAttempt(calls_.all().front()))
    throw InputError(record_folder, "the record does not say what the devices answered",
                     "a run that this version or a later one measured");
  for (std::size_t k = 0; k < calls_.all().size(); ++k) {
    const DeviceCall& call = calls_.all()[k];
    if (!BeginsAttempt(call)) continue;
    ++attempts_;
    is_simulation_ = call.answer == kOnSimulation;
    if (is_simulation_) begin_ = k;
  }
  asked_ = std::make_unique<AskedMachine>(
      [this](const std::string& device, const std::string& request) { return Answer(device, request); },
      [this] { return Now(); },
      AskedMachine::Parts{std::move(axes), std::move(shown), has_indexer,
                          is_simulation_ ? static_cast<Simulation*>(this) : nullptr});
  Restart();
}

ReplayMachine::~ReplayMachine() = default;

MachineBench ReplayMachine::Devices() {
  return asked_->Bench();
}

void ReplayMachine::Restart() {
  calls_.GoTo(begin_);
  may_begin_ = true;
  now_ = Time{};
}

bool ReplayMachine::AtAttempt() const {
  return !calls_.AtEnd() && BeginsAttempt(calls_.Ahead());
}

void ReplayMachine::PassAttempt() {
  if (!may_begin_)
    throw DeviceFault(FaultKind::kGap, "recording", "the run went no further in this attempt; it began another one");
  may_begin_ = false;
  now_ = calls_.Next(kRunDevice, kAttemptBegins).time;
}

std::string ReplayMachine::Answer(const std::string& device, const std::string& request) {
  if (device == "machine" && request == "stop") {  // behind a fault; the record keeps nothing of it
    may_begin_ = true;
    throw NothingMoves();
  }
  if (AtAttempt()) PassAttempt();
  const DeviceCall& call = calls_.Next(device, request);
  now_ = call.time;
  return call.answer;
}

Time ReplayMachine::Now() {
  if (may_begin_ && AtAttempt()) PassAttempt();
  const bool was_looked_at =
      !calls_.AtEnd() && calls_.Ahead().device == kClockDevice && calls_.Ahead().request == kClockShows;
  if (was_looked_at) now_ = calls_.Next(kClockDevice, kClockShows).time;
  return now_;
}

}  // namespace twinbench::hw
