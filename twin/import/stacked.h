#pragma once

#include "twin/import/map.h"
#include "twin/import/recording.h"

/// Tables that have a column for each way round.
namespace twinbench::imports {

/// Puts columns whose names say a way round ("CCW [µm]", "run 2 cw") below each other, with a column "direction"
/// and one "run"; an angle of its own way round goes with each. Of a map that seeks a way round; other tables stay
/// as they are. Of one that seeks clampings those whose names say one likewise ("clamping 2", "30 deg"), with
/// columns "clamping" and "offset"; lines between rows may say it as well.
void StackTurns(const Map& map, Track& track);

/// Of a map that seeks balls: puts columns of several balls ("dx1, dy1, dx2, dy2") below each other, with a column "ball".
void StackBalls(const Map& map, Track& track);

}  // namespace twinbench::imports
