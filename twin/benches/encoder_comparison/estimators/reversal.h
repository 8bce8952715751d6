#pragma once

#include "twin/benches/encoder_comparison/estimators/comparison_fit.h"

namespace twinbench::separate::encoder {

struct MeanReversal {
  double value_rad = kNaN;  // NaN if no set-up went both ways
  double u_rad = kNaN;      // NaN if no direction of a set-up has two passes
  double white_share = kNaN;  // of its square: what white noise of the readings makes
  double rounding_share = 0.0;  // and what rounding makes that repeats in every pass
};

/// Mean over the turn of forward - backward, and over the set-ups: from the constants of the passes.
///
/// Uncertainty: scatter of the constants between passes, pooled over all set-ups and directions; drift from pass to
/// pass is in it. Never less than the noise of the readings lets it be, even if passes agree by chance, and the rounding that all of them repeat besides.
MeanReversal ReversalOf(const ComparisonFit& fitted);

}  // namespace twinbench::separate::encoder
