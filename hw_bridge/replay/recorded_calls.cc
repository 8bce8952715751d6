#include "hw_bridge/replay/recorded_calls.h"

#include <fmt/format.h>

#include "twin/core/errors.h"

namespace twinbench::hw {

RecordedCalls::RecordedCalls(std::string folder, std::vector<DeviceCall> calls)
    : folder_(std::move(folder)), calls_(std::move(calls)) {
  if (calls_.empty())
    throw InputError(folder_, "the record does not say what was asked of the devices",
                     "a run that `measure` carried out, not an imported file");
}

const DeviceCall& RecordedCalls::Next(const std::string& device, const std::string& request) {
  const std::string asked = fmt::format("\"{}: {}\"", device, request);
  if (AtEnd()) throw BenchError(fmt::format("{}: the recording ends before {}", folder_, asked));
  const DeviceCall& call = calls_[next_];
  if (call.device != device || call.request != request)
    throw BenchError(fmt::format("{}: {} is not in the recording at this place, \"{}: {}\" is (call {})", folder_,
                                 asked, call.device, call.request, next_));
  ++next_;
  return call;
}

}  // namespace twinbench::hw
