#include "hw_bridge/ad/host_stamp.h"

#include <chrono>

namespace twinbench::hw {
namespace {

template <class Clock>
std::int64_t NanosecondsOf() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now().time_since_epoch()).count();
}

}  // namespace

BlockStamp HostStamp() {
  BlockStamp stamp;
  stamp.host_ns = NanosecondsOf<std::chrono::steady_clock>();
  stamp.utc_ns = NanosecondsOf<std::chrono::system_clock>();
  return stamp;
}

}  // namespace twinbench::hw
