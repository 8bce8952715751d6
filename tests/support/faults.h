#pragma once

#include <optional>

#include "twin/core/device_fault.h"

namespace twinbench::test {

/// The fault that a call ends in; nothing if it does not.
template <class Call>
std::optional<DeviceFault> FaultOf(Call call) {
  try {
    call();
  } catch (const DeviceFault& fault) {
    return fault;
  }
  return std::nullopt;
}

/// Which that is.
template <class Call>
std::optional<FaultKind> KindOf(Call call) {
  const std::optional<DeviceFault> fault = FaultOf(call);
  return fault ? std::optional(fault->kind()) : std::nullopt;
}

/// What it says; empty without one.
template <class Call>
std::string TextOf(Call call) {
  const std::optional<DeviceFault> fault = FaultOf(call);
  return fault ? fault->what() : "";
}

/// The same without the address of the device at its end, which is another in every run.
template <class Call>
std::string TextWithoutAddress(Call call) {
  const std::string text = TextOf(call);
  return text.substr(0, text.rfind(" (tcp:"));
}

}  // namespace twinbench::test

namespace twinbench {
inline void PrintTo(FaultKind kind, std::ostream* out) { *out << FaultName(kind); }
}  // namespace twinbench
