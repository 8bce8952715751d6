#include "tests/investigate/hidden_investigation.h"

#include <gtest/gtest.h>

#include "tests/core/input_error.h"

namespace twinbench::investigate {
namespace {

// Five of the score's seeds in a row: a scale, an ellipticity, a slip, a drift, an order of a half. More of them by
// tools/scores --set investigate.
TEST(InvestigateAProgram, TellsWhatABenchHidesThatSharesNothingWithTheTwin) {
  const TemporaryFolder folder;
  constexpr std::uint64_t kFirst = 5, kLast = 9;
  int right = 0;
  for (std::uint64_t seed = kFirst; seed <= kLast; ++seed) {
    const Judged judged = InvestigateProgram(TWINBENCH_TEST_DATA "/program/acquire_hidden.py", seed,
                                             folder.File(std::to_string(seed)));
    right += judged.IsRight() ? 1 : 0;
    EXPECT_FALSE(judged.result == Result::kWrong && judged.probability > 0.95)
        << judged.truth << ": " << judged.answer;
  }
  EXPECT_GE(right, 4);
}

}  // namespace
}  // namespace twinbench::investigate
