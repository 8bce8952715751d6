#include "hw_bridge/replay/replay_bench.h"

#include <algorithm>

#include "twin/core/errors.h"
#include "twin/core/nothing_moves.h"

namespace twinbench::hw {

bool LooksAtEncoders(const std::string& record_folder) {
  const std::vector<DeviceCall> calls = RunRecord::Open(record_folder)->Calls();
  const auto block = std::ranges::find(calls, "adc", &DeviceCall::device);
  return block != calls.begin() && block != calls.end() && std::prev(block)->request == "state";
}

ReplayBench::ReplayBench(const std::string& record_folder)
    : ReplayBench(record_folder, *RunRecord::Open(record_folder)) {}

ReplayBench::ReplayBench(const std::string& record_folder, const RunRecord& record)
    : folder_(record_folder),
      calls_(record_folder, record.Calls()),
      readings_(record.Readings()),
      blocks_(record.RawBlocks()) {
  asked_ = std::make_unique<AskedBench>(
      [this](const std::string& device, const std::string& request) { return Answer(device, request); },
      [this] { return now_; }, static_cast<Simulation*>(this));
}

ReplayBench::~ReplayBench() = default;

RotaryBench ReplayBench::Bench() {
  return asked_->Bench();
}

void ReplayBench::Restart() {
  calls_.GoTo(0);
  next_reading_ = 0;
  now_ = Time{};
}

CallAnswer ReplayBench::Answer(const std::string& device, const std::string& request) {
  const bool is_recorded = !calls_.AtEnd() && calls_.Ahead().request == request;
  if (request == "stop" && !is_recorded) throw NothingMoves();  // behind a fault, of which a run keeps nothing
  const DeviceCall& call = calls_.Next(device, request);
  now_ = call.time;
  return {call.answer, device == "adc" ? BlockOf(call) : Acquisition{}};
}

/// Every block that was kept belongs to a reading, and they come in the same order.
Acquisition ReplayBench::BlockOf(const DeviceCall& call) {
  Acquisition block = ParseBlock(call.answer);
  if (next_reading_ >= readings_.size())
    throw InputError(folder_, "the record holds more blocks than readings", "an undamaged record");
  const int reading = readings_[next_reading_++].reading;
  const auto raw = std::ranges::find(blocks_, reading, &RawBlock::reading);
  if (raw != blocks_.end()) {
    block.raw = raw->samples;
    block.stamp = raw->stamp;
  }
  return block;
}

}  // namespace twinbench::hw
