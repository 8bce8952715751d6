#pragma once

namespace twinbench::separate {

/// Fewer degrees of freedom are none: where they come as a sum, the rest is its rounding errors.
inline constexpr double kLeastDof = 0.5;

}  // namespace twinbench::separate
