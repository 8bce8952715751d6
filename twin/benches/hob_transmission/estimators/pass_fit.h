#pragma once

#include <vector>

#include "twin/benches/hob_transmission/estimators/turn_fit.h"
#include "twin/benches/hob_transmission/estimators/turns.h"

namespace twinbench::separate::hob {

struct FittedTurn {
  int index = 0;
  TurnFit fit;
};

/// Slope of the turn means of one pass over the number of the turn; zero unless known.
struct Drift {
  double rad_per_turn = 0.0;
  double variance = 0.0;
  bool known = false;
};

struct FittedPass {
  std::vector<FittedTurn> turns;
  int left_out = 0;  // not determined, or inflated beyond the limit
  Drift drift;
};

/// Fits the turns of one pass, and a steady drift if there are three of them.
FittedPass FitPass(const Pass& pass, const TransmissionOptions& options);

}  // namespace twinbench::separate::hob
