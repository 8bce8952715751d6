#pragma once

#include "twin/core/number_text.h"

namespace twinbench {

/// A finite SI value in a unit, as a person would write it: 350 and not 349.99999999999994, wherever both are the same
/// SI value.
inline double WrittenNumber(double value_SI, double to_SI) {
  return ParseNumber(PrintInUnit(value_SI, to_SI)).value_or(value_SI / to_SI);
}

}  // namespace twinbench
