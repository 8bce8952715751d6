#pragma once

#include <exception>
#include <functional>
#include <string>

#include "twin/procedure/standstill.h"

namespace twinbench::tools {

/// Ends a measurement that was stopped in words that hold what was read back.
/// @param why   What stopped it.
/// @param what  "tables", "axes".
/// @param stop  Brings them to rest, where the run itself has not (procedure::StoppedRun).
/// @throws BenchError, or StateUnknown where nobody knows whether they stand.
[[noreturn]] void TellStopped(const std::exception& why, const std::string& what,
                              const std::function<procedure::Standstill()>& stop);

}  // namespace twinbench::tools
