#pragma once

#include <numbers>

namespace twinbench::mechanics {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kDegree = kPi / 180.0;
inline constexpr double kArcsec = kDegree / 3600.0;
inline constexpr double kMicrometre = 1e-6;

}  // namespace twinbench::mechanics
