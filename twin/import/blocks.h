#pragma once

#include <map>
#include <string>
#include <vector>

#include "twin/import/course.h"
#include "twin/import/join.h"

/// Rows of a set-up put together to readings.
namespace twinbench::imports {

/// Several neighbouring rows: [begin, end).
struct Block {
  std::size_t begin = 0, end = 0;
};

struct Blocks {
  std::vector<Block> blocks;
  std::size_t left_out = 0;  // rows between stops, on the way
  double widest = 0.0;       // of a block in motion [rad]
  std::size_t usual_rows = 1;
};

/// A recording of stops in time has one block a rest, without the rows in which the axis still settles; several
/// where there are less than a dozen rests. One of motion is cut into at most about `most` blocks that never span
/// a reversal, a rest's end, a gap or a ramp's end; behind a reversal, where play is crossed, they are an eighth as
/// long.
///
/// Stops are kept one by one, unless they are as close as the entries of a firmware's table. Where that would lose
/// orders below 30, there are up to four times as many.
///
/// A block of width w lowers a wave of order k by (k w)^2 / 24: one part in a hundred at k = 0.49 / w.
Blocks CutIntoBlocks(const Course& course, const std::vector<double>& time_s, std::size_t most, bool stop_and_go);

/// The highest order of which blocks of that width keep 99 %; 0 where nothing is averaged.
int HighestOrderKept(double widest_rad);

}  // namespace twinbench::imports
