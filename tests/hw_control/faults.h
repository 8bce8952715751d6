#pragma once

#include <optional>
#include <ostream>
#include <string>

#include "twin/core/device_fault.h"

namespace twinbench::test {

/// Which fault a call ends in; nothing if it does not.
template <class Call>
std::optional<FaultKind> KindOf(Call call) {
  try {
    call();
  } catch (const DeviceFault& fault) {
    return fault.kind();
  }
  return std::nullopt;
}

/// What the fault says; empty without one.
template <class Call>
std::string TextOf(Call call) {
  try {
    call();
  } catch (const DeviceFault& fault) {
    return fault.what();
  }
  return {};
}

/// The same without the address of the device at its end, which is another in every run.
template <class Call>
std::string TextWithoutAddress(Call call) {
  const std::string text = TextOf(call);
  return text.substr(0, text.rfind(" (tcp:"));
}

}  // namespace twinbench::test

namespace twinbench {
inline void PrintTo(FaultKind kind, std::ostream* out) {
  *out << FaultName(kind);
}
}  // namespace twinbench
