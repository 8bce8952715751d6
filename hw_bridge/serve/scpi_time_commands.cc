#include "hw_bridge/serve/scpi_commands.h"
#include "hw_bridge/serve/scpi_parameters.h"

/// The clock of the bench, and what only a simulated bench can do.
namespace twinbench::hw {
namespace {

constexpr long long kLongestWait_ns = 10'000'000'000'000'000;
constexpr long long kMostRuns = 1'000'000;

std::string NowText(Served& served) {
  return std::to_string(served.pace().Now().time_since_epoch().count());
}

[[noreturn]] void RefuseToOthers() {
  throw ScpiError{-221, "another client holds the clock"};
}

Outcome Now(const ScpiCall& call) {
  call.served.pace().CatchUp();
  return {NowText(call.served), nullptr};
}

Outcome Hold(const ScpiCall& call) {
  if (!call.served.pace().Hold(&call.client, ScpiSwitch(call.parameters[0]))) RefuseToOthers();
  return {};
}

Outcome Pass(const ScpiCall& call) {
  const Duration duration(ScpiWholeNumber(call.parameters[0], 0, kLongestWait_ns));
  const Poll pass = call.served.pace().Pass(duration);
  return {"", [pass, &served = call.served]() -> std::optional<std::string> {
            return pass() ? std::optional(NowText(served)) : std::nullopt;
          }};
}

Outcome Restart(const ScpiCall& call) {
  if (call.served.pace().HeldByAnother(&call.client)) RefuseToOthers();
  std::optional<int> run;
  if (!call.parameters.empty()) run = static_cast<int>(ScpiWholeNumber(call.parameters[0], 0, kMostRuns));
  call.served.Restart(run);
  return {};
}

Outcome SetPaced(const ScpiCall& call) {
  if (call.served.pace().HeldByAnother(&call.client)) RefuseToOthers();
  call.served.pace().SetPaced(&call.client, ScpiSwitch(call.parameters[0]));
  return {};
}

Outcome Fault(const ScpiCall& call) {
  const bool counted = call.parameters.size() == 3;
  const long long count = counted ? ScpiWholeNumber(call.parameters[2], 1, 1'000'000) : 1;
  if (!call.served.faults.Add(call.parameters[0], call.parameters[1], count)) throw ScpiError{-224, ""};
  return {};
}

Outcome WaitingFaults(const ScpiCall& call) {
  return {'"' + call.served.faults.Waiting() + '"', nullptr};
}

// clang-format off
constexpr ScpiCommand kTimeCommands[] = {
    {"CLOCk:NOW", true, 0, 0, Now},
    {"CLOCk:HOLD", false, 1, 0, Hold},
    {"CLOCk:WAIT", true, 1, 0, Pass},
    {"SIMulation:RESTart", false, 0, 1, Restart},
    {"SIMulation:PACE", false, 1, 0, SetPaced},
    {"SIMulation:FAULt", false, 2, 1, Fault},
    {"SIMulation:FAULt", true, 0, 0, WaitingFaults},
};
// clang-format on

}  // namespace

std::span<const ScpiCommand> ScpiTimeCommands() {
  return kTimeCommands;
}

}  // namespace twinbench::hw
