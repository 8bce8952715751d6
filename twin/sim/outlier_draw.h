#pragma once

#include <cstdint>

#include "twin/core/scenario.h"
#include "twin/core/stream.h"

namespace twinbench::sim {

/// Now and then a reading is off by 0.5 to 1.5 times the typical size, either way. Which ones, follows from their
/// numbers.
class OutlierDraw {
 public:
  /// @param effect  With `fraction` and `size`.
  OutlierDraw(const EffectSettings& effect, std::uint64_t seed);

  struct Drawn {
    double size = 0.0;     // signed; 0: this reading is none
    double uniform = 0.0;  // for what else there is to be chosen
  };
  Drawn At(int reading) const;

 private:
  double fraction_, size_;
  std::uint64_t seed_;
};

}  // namespace twinbench::sim
