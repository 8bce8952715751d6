#include <utility>

#include "twin/diagnose/screen/raw_blocks.h"
#include "twin/diagnose/screen/screen.h"

namespace twinbench::diagnose {

std::vector<ScreenTest> ScreenRaw(const std::vector<RawBlock>& blocks, const RawScale& scale, int null_runs,
                                  std::uint64_t seed) {
  const screen::ThinnedBlocks thinned = screen::Thin(blocks, scale);
  std::vector<ScreenTest> all = screen::TestHum(thinned, scale, null_runs, seed);
  for (ScreenTest& t : screen::TestRingDown(thinned, scale, null_runs, seed)) all.push_back(std::move(t));
  for (ScreenTest& t : screen::TestCodes(blocks, scale, null_runs, seed)) all.push_back(std::move(t));
  return all;
}

}  // namespace twinbench::diagnose
