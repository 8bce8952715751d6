#pragma once

#include <map>
#include <string>
#include <vector>

#include "twin/import/course.h"
#include "twin/import/join.h"
#include "twin/import/rests.h"

/// Rows of a set-up put together to readings.
namespace twinbench::imports {

/// Several neighbouring rows: [begin, end).
struct Block {
  std::size_t begin = 0, end = 0;
  std::size_t rest = 0;  // of a stop: the row in which the command began to rest
};

struct Blocks {
  std::vector<Block> blocks;
  std::size_t left_out = 0;  // rows between stops, on the way
  std::size_t moving = 0, moving_rests = 0;  // rows, and rests of the command, at whose end the device was still on its way
  double widest = 0.0;       // of a block in motion [rad]
  std::size_t usual_rows = 1;
};

/// How many readings a recording may have.
struct MostReadings {
  std::size_t count = 0;
  bool is_stated = false;  // by whoever imports it, and kept; else it is about as many
};

/// A recording of stops in time has one block a rest, of the rows in which the device stands; several where there are less
/// than a dozen rests. One of motion is cut into at most about `most` blocks - if that is stated, into no more - that never span
/// a reversal, a rest's end, a gap or a ramp's end; behind a reversal, where play is crossed, they are an eighth as
/// long.
///
/// Stops are kept one by one, unless they are as close as the entries of a firmware's table. Where that would lose
/// orders below 30, there are up to four times as many, if nobody stated a number.
///
/// A block of width w lowers a wave of order k by (k w)^2 / 24: one part in a hundred at k = 0.49 / w.
///
/// @param rests  Of a recording of stops; empty: of one in motion, or with a row a stop.
Blocks CutIntoBlocks(const Course& course, const std::vector<double>& time_s, const MostReadings& most,
                     const std::vector<Rest>& rests);

/// The highest order of which blocks of that width keep 99 %; 0 where nothing is averaged.
int HighestOrderKept(double widest_rad);

}  // namespace twinbench::imports
