#pragma once

#include <stdexcept>
#include <string>

#include "twin/core/errors.h"

namespace twinbench {

/// What `make` makes; of what bodies or light cannot be the scenario is told to be at fault.
template <class Make>
auto Built(const std::string& bench, const Make& make) {
  try {
    return make();
  } catch (const std::invalid_argument& error) {
    throw InputError("bench " + bench, error.what(), "a scenario of parts that can be built");
  }
}

}  // namespace twinbench
