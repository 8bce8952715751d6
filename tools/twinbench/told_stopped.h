#pragma once

#include <exception>
#include <string>

#include "twin/procedure/standstill.h"

namespace twinbench::tools {

/// Ends a measurement that was stopped in words that hold what was read back.
/// @param why   What stopped it.
/// @param what  "tables", "axes".
/// @throws BenchError, or StateUnknown where nobody knows whether they stand.
[[noreturn]] void TellStopped(const std::exception& why, const std::string& what,
                              const procedure::Standstill& stands);

}  // namespace twinbench::tools
