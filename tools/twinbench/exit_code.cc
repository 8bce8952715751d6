#include "tools/twinbench/exit_code.h"

#include "tools/twinbench/terminal.h"
#include "twin/core/errors.h"
#include "twin/core/state_unknown.h"

namespace twinbench::tools {

ExitCode ExitCodeOf(const std::exception& error) {
  if (dynamic_cast<const InputError*>(&error)) return kBadInput;
  return dynamic_cast<const StateUnknown*>(&error) ? kStateUnknown : kWorldFailed;
}

std::string FailureText(const std::exception& error) {
  return "twinbench: " + ForTerminal(error.what());
}

}  // namespace twinbench::tools
