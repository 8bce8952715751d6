#include "tools/twinbench/told_stopped.h"

#include <fmt/format.h>

#include <string>

#include "twin/core/device_fault.h"
#include "twin/core/state_unknown.h"

namespace twinbench::tools {
namespace {

std::string Reason(const std::exception& why) {
  const auto* fault = dynamic_cast<const DeviceFault*>(&why);
  if (!fault) return fmt::format("stopped: {}", why.what());
  if (fault->kind() == FaultKind::kStopped) return "stopped by the operator";
  return fmt::format("stopped: {} ({})", fault->what(), FaultName(fault->kind()));
}

}  // namespace

void TellStopped(const std::exception& why, const std::string& what, const std::function<procedure::Standstill()>& stop) {
  const auto* stopped = dynamic_cast<const procedure::StoppedRun*>(&why);
  const procedure::Standstill stands = stopped ? stopped->stands() : stop();
  const auto* fault = dynamic_cast<const DeviceFault*>(&why);
  const bool goes_on = !fault || fault->kind() != FaultKind::kChanged;
  const std::string kept = std::string("every reading so far is kept") + (goes_on ? ". Go on with --resume" : "");
  if (!stands.is_sure)
    throw StateUnknown(fmt::format("{}. STATE UNKNOWN - USE THE EMERGENCY STOP. WHETHER THE {} STAND STILL IS NOT KNOWN: "
                                   "{}; {}",
                                   Reason(why), what == "axes" ? "AXES" : "TABLES", stands.why_not, kept));
  throw BenchError(fmt::format("{}. The {} were brought to rest. The controller says that all {} stand still; {}",
                               Reason(why), what, what, kept));
}

}  // namespace twinbench::tools
