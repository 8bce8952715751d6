#pragma once

#include <vector>

#include "twin/diagnose/compared.h"

/// What a run leaves open: constants of its set-ups and places, and those that are known to some extent.
namespace twinbench::diagnose {

/// Points with their courses, those of places first.
std::vector<FreePoint> FreeOf(const Compared& compared, const TwinComparison& comparison);

/// What each row shows of the constants that are known to some extent: columns behind those of the free ones.
void AddKnown(const std::vector<Reading>& readings, const Scenario& scenario, const TwinComparison& comparison,
              Compared& compared);

/// Free constants are counted from nothing. Those that are known stay where they are: the twin does not follow them
/// here, and so nothing of theirs is put back.
LeftByAnother LeftByAnotherOf(const Compared& compared, const std::vector<Reading>& readings,
                              const TwinComparison& comparison);

}  // namespace twinbench::diagnose
