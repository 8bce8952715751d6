#pragma once

#include <chrono>
#include <string>

namespace twinbench::procedure {

/// Real time between the two looks of who asks whether something stands that nobody told to stop. A simulated bench's own
/// time stands between its calls anyway.
inline constexpr auto kBetweenTwoLooks = std::chrono::milliseconds(50);

/// Whether what was told to stop stands, as its controller says.
struct Standstill {
  bool is_sure = false;
  std::string why_not;  // what moves, or why nobody knows
};

}  // namespace twinbench::procedure
