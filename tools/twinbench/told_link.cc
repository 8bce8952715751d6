#include "tools/twinbench/told_link.h"

#include <fmt/core.h>

#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <mutex>

#include "hw_bridge/control/waiting.h"

namespace twinbench::tools {
namespace {

constexpr auto kBetweenLooks = std::chrono::milliseconds(200);
constexpr const char* kEmergency = "If anything moves that must not, USE THE EMERGENCY STOP.";

void Watch(const std::stop_token& stop) {
  std::string told;
  std::mutex mutex;
  std::condition_variable_any ended;
  std::unique_lock lock(mutex);
  while (!ended.wait_for(lock, stop, kBetweenLooks, [&] { return stop.stop_requested(); })) {
    const std::string overdue = hw::Waiting::Overdue();
    if (!overdue.empty() && overdue != told) fmt::print(stderr, "\n{} does not answer; the link is being tried. {}\n", overdue, kEmergency);
    told = overdue;
  }
}

}  // namespace

LinkWatch::LinkWatch() : watch_(Watch) {}

void TellFault(const DeviceFault& fault) {
  if (fault.kind() == FaultKind::kStopped) return;  // who said so knows it, and was told
  fmt::print(stderr, "\n{} ({}). What moves is commanded to stop. {}\n", fault.what(), FaultName(fault.kind()), kEmergency);
}

}  // namespace twinbench::tools
