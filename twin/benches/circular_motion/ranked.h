#pragma once

#include <string>
#include <vector>

#include "twin/benches/circular_motion/analysis.h"

/// The errors that were fitted as users of ball bars know them: ranked by what each makes of the circle.
namespace twinbench::benches::circular {

/// One error at one feed of one mounting. The centre's offset is none.
struct RankedError {
  int setup = 0;
  double feed_m_s = 0.0;
  std::string name;          // "backlash x"
  ErrorValue size;           // of a wave its amplitude
  double alone_m = kNaN;     // G(b) of a machine that has this error alone
  double share = kNaN;       // of the sum of these
  bool IsSignificant() const { return std::abs(size.value) > 2.0 * size.u; }
};

/// The largest first, feed by feed; of what the readings show only.
std::vector<RankedError> RankedErrors(const CircleAnalysis& analysis);

}  // namespace twinbench::benches::circular
