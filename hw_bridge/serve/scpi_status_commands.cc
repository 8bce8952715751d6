#include <fmt/format.h>

#include <utility>

#include "hw_bridge/serve/scpi_commands.h"
#include "hw_bridge/serve/scpi_parameters.h"

/// Common commands of IEEE 488.2, status and errors.
namespace twinbench::hw {
namespace {

Outcome Identify(const ScpiCall& call) {
  return {fmt::format("twinbench,{},{},{}", call.served.name, call.served.serial, TWINBENCH_VERSION), nullptr};
}

Outcome OperationComplete(const ScpiCall& call) {
  return {"", call.served.AtRest("1")};
}

Outcome WaitToContinue(const ScpiCall& call) {
  return {"", call.served.AtRest("")};
}

Outcome SetOperationComplete(const ScpiCall& call) {
  if (!call.served.Moves()) call.client.status().events |= 1;
  return {};
}

Outcome ClearStatus(const ScpiCall& call) {
  call.client.errors().Clear();
  call.client.status().events = 0;
  return {};
}

Outcome Events(const ScpiCall& call) {
  return {std::to_string(std::exchange(call.client.status().events, 0)), nullptr};
}

Outcome StatusByte(const ScpiCall& call) {
  const ScpiConversation::Status& status = call.client.status();
  int byte = call.client.errors().Empty() ? 0 : 4;
  if ((status.events & status.event_mask) != 0) byte |= 32;
  if ((byte & status.service_mask) != 0) byte |= 64;
  return {std::to_string(byte), nullptr};
}

Outcome SetEventMask(const ScpiCall& call) {
  call.client.status().event_mask = static_cast<int>(ScpiWholeNumber(call.parameters[0], 0, 255));
  return {};
}

Outcome EventMask(const ScpiCall& call) {
  return {std::to_string(call.client.status().event_mask), nullptr};
}

Outcome SetServiceMask(const ScpiCall& call) {
  call.client.status().service_mask = static_cast<int>(ScpiWholeNumber(call.parameters[0], 0, 255));
  return {};
}

Outcome ServiceMask(const ScpiCall& call) {
  return {std::to_string(call.client.status().service_mask), nullptr};
}

Outcome SelfTest(const ScpiCall&) {
  return {"0", nullptr};
}

Outcome NextError(const ScpiCall& call) {
  return {call.client.errors().Next(), nullptr};
}

Outcome ScpiVersion(const ScpiCall&) {
  return {"1999.0", nullptr};
}

std::string_view WithoutQuotes(std::string_view text) {
  const bool quoted = text.size() >= 2 && (text.front() == '"' || text.front() == '\'') && text.back() == text.front();
  return quoted ? text.substr(1, text.size() - 2) : text;
}

Outcome ShowToken(const ScpiCall& call) {
  if (!call.client.Show(WithoutQuotes(call.parameters[0]))) throw ScpiError{-203, "this is not the token"};
  return {};
}

Outcome MayChange(const ScpiCall& call) {
  return {call.client.MayChange() ? "1" : "0", nullptr};
}

Outcome ArmWatchdog(const ScpiCall& call) {
  const double patience_s = ScpiNumber(call.parameters[0], 1.0);
  if (!(patience_s >= 0.0 && patience_s <= CommandConversation::kLongestPatience_s)) throw ScpiError{-222, ""};
  call.client.BeMissed(patience_s);
  return {};
}

Outcome WatchdogPatience(const ScpiCall& call) {
  return {PrintScpi(call.client.Patience_s(), 1.0), nullptr};
}

// clang-format off
constexpr ScpiCommand kStatusCommands[] = {
    {"*IDN", true, 0, 0, Identify},
    {"*OPC", true, 0, 0, OperationComplete},
    {"*OPC", false, 0, 0, SetOperationComplete},
    {"*WAI", false, 0, 0, WaitToContinue},
    {"*CLS", false, 0, 0, ClearStatus},
    {"*RST", false, 0, 0, StopScpiDevices},
    {"*ESR", true, 0, 0, Events},
    {"*ESE", false, 1, 0, SetEventMask},
    {"*ESE", true, 0, 0, EventMask},
    {"*SRE", false, 1, 0, SetServiceMask},
    {"*SRE", true, 0, 0, ServiceMask},
    {"*STB", true, 0, 0, StatusByte},
    {"*TST", true, 0, 0, SelfTest},
    {"SYSTem:ERRor", true, 0, 0, NextError},
    {"SYSTem:ERRor:NEXT", true, 0, 0, NextError},
    {"SYSTem:VERSion", true, 0, 0, ScpiVersion},
    {"SYSTem:WATChdog", false, 1, 0, ArmWatchdog},
    {"SYSTem:WATChdog", true, 0, 0, WatchdogPatience},
    {"SYSTem:TOKen", false, 1, 0, ShowToken},
    {"SYSTem:TOKen", true, 0, 0, MayChange},
    {"ABORt", false, 0, 0, StopScpiDevices},
};
// clang-format on

}  // namespace

std::span<const ScpiCommand> ScpiStatusCommands() {
  return kStatusCommands;
}

}  // namespace twinbench::hw
