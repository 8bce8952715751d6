#pragma once

#include "twin/diagnose/engine/search.h"
#include "twin/diagnose/engine/take_best.h"

namespace twinbench::diagnose {

/// Where several causes are there at once, what explains most of all of them at the first step may be none of them, and what is taken next
/// stands beside that. Causes without a shape need no steps: all are fitted together, those are dropped that are not needed, and what is the
/// more probable of all of it stays. Of several channels: a cause shows on them together, what has no name on each by itself; on one channel
/// nothing but its size would speak for the cause.
void TryTogether(SearchProblem problem, SearchResult& result);

}  // namespace twinbench::diagnose
