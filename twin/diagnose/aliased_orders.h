#pragma once

#include <vector>

#include "twin/diagnose/diagnose.h"

namespace twinbench::diagnose {

/// Orders that these readings do not tell from a cause's own, ascending: at N even stops a turn k, N - k and N + k are one wave.
/// Empty of a cause without an order, and where the stops are uneven enough for its size.
std::vector<int> AliasesOf(const Cause& cause, const LinearRun& run);

/// Names the first aliases of each cause as its rivals, with what tells them apart; a cause that has some improves the same stops
/// only, and no other run. One that is about as likely as the order that was named leaves that open: the verdict is a tie.
void TellAliases(const LinearRun& run, Diagnosis& diagnosis);

}  // namespace twinbench::diagnose
