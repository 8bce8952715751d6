#pragma once

#include <string>

namespace twinbench::procedure {

/// Whether what was told to stop stands, as its controller says.
struct Standstill {
  bool is_sure = false;
  std::string why_not;  // what moves, or why nobody knows
};

}  // namespace twinbench::procedure
