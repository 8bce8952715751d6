#pragma once

#include <cmath>
#include <stdexcept>
#include <string>

/// What a part asks of its parameters; each throws std::invalid_argument.
namespace twinbench::mechanics {

inline void Require(bool holds, const char* what) {
  if (!holds) throw std::invalid_argument(what);
}

inline void RequirePositive(double value, const char* what) {
  if (!(value > 0.0) || !std::isfinite(value)) throw std::invalid_argument(std::string(what) + " must be positive");
}

inline void RequireNotNegative(double value, const char* what) {
  if (!(value >= 0.0) || !std::isfinite(value))
    throw std::invalid_argument(std::string(what) + " must not be negative");
}

}  // namespace twinbench::mechanics
