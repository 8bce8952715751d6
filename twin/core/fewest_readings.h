#pragma once

#include <cstddef>

namespace twinbench {

/// Readings of a comparison below which no diagnosis is made.
inline constexpr std::size_t kFewestToDiagnose = 8;

}  // namespace twinbench
