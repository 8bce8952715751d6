#pragma once

#include <optional>

#include "tests/shelf/judge.h"

/// Recordings as people have them: imported by a plain guess, then diagnosed, as the two commands do it.
namespace twinbench::shelf {

/// Numbers of the files in tests/data/shelf, in order.
std::vector<std::string> CaseNames();

struct Answer {
  Judged judged;
  std::string truth, words;  // in words; of a file that is refused, why
  std::optional<std::string> second;  // what a second diagnosis with the written file says; nothing: it was not asked
};

/// @param asks_again  Diagnose the same readings with the written file, with thresholds that are kept.
Answer Examine(const std::string& name, bool asks_again);

}  // namespace twinbench::shelf
