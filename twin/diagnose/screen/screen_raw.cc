#include <utility>

#include "twin/diagnose/screen/moderated.h"
#include "twin/diagnose/screen/raw_blocks.h"
#include "twin/diagnose/screen/screen.h"

namespace twinbench::diagnose {

std::vector<ScreenTest> ScreenRaw(const std::vector<RawBlock>& blocks, const RawScale& scale, int null_runs,
                                  std::uint64_t seed) {
  const screen::ThinnedBlocks thinned = screen::Thin(blocks, scale);
  std::vector<ScreenTest> all;
  const auto keep = [&all](screen::Tests tests) {
    for (ScreenTest& test : tests) all.push_back(screen::Moderated(std::move(test)));
  };
  keep(screen::TestHum(thinned, scale, null_runs, seed));
  keep(screen::TestRingDown(thinned, scale, null_runs, seed));
  keep(screen::TestRawAllan(thinned, scale, null_runs, seed));
  keep(screen::TestCodes(blocks, scale, null_runs, seed));
  keep(screen::TestSettling(blocks, scale, null_runs, seed));
  return all;
}

}  // namespace twinbench::diagnose
