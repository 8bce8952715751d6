#include <fmt/format.h>

#include <algorithm>

#include "twin/diagnose/screen/raw_blocks.h"
#include "twin/diagnose/screen/screen.h"

namespace twinbench::diagnose {

std::string RawLimitsInWords(const std::vector<RawBlock>& blocks, const RawScale& scale) {
  constexpr double kMainsPeriod_s = 0.02;
  const double duration_s = screen::Thin(blocks, scale).Duration_s();
  if (blocks.empty() || duration_s > kMainsPeriod_s * (1.0 - 1e-9)) return "";
  return fmt::format(
      "Raw blocks of {:.3g} ms hold no whole period of the mains ({:.0f} ms): hum is not looked for in them, and "
      "shows "
      "only as scatter and tones of the readings.",
      1e3 * duration_s, 1e3 * kMainsPeriod_s);
}

}  // namespace twinbench::diagnose
