#include "twin/import/blocks.h"

#include <algorithm>
#include <cmath>

#include "twin/core/units.h"
#include "twin/import/common.h"

namespace twinbench::imports {
namespace {

constexpr double kOneInAHundred = 0.49;  // rad of a wave: a block as wide lowers it by 1 %
constexpr int kOrdersWanted = 30;
constexpr double kDense_rad = 0.5 * units::deg;
constexpr std::size_t kBehindReversal = 40;  // short blocks there

/// True if rows i - 1 and i cannot be in one block.
/// @param joins  Ramps with what is between them.
bool Parts(const Course& course, const std::vector<double>& time_s, double usual_s, std::size_t i, bool joins) {
  return course.pass[i] != course.pass[i - 1] || course.direction[i] != course.direction[i - 1] ||
         (!joins && course.motion[i] != course.motion[i - 1]) || time_s[i] - time_s[i - 1] > kGapIntervals * usual_s;
}

double UsualInterval(const std::vector<double>& time_s) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < time_s.size(); ++i) steps.push_back(time_s[i] - time_s[i - 1]);
  if (steps.empty()) return 0.0;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::ranges::nth_element(steps, middle);
  return *middle;
}

/// In about equal pieces of three rows at least.
void AddPieces(const Rest& rest, std::size_t pieces, std::vector<Block>& blocks) {
  constexpr std::size_t kFewestRows = 3;
  const std::size_t rows = rest.end - rest.stands;
  pieces = std::clamp<std::size_t>(rows / kFewestRows, 1, pieces);
  for (std::size_t k = 0; k < pieces; ++k)
    blocks.push_back({rest.stands + rows * k / pieces, rest.stands + rows * (k + 1) / pieces, rest.begin});
}

/// Rests become one reading each; several where there would be too few for anything else.
Blocks CutStops(const Course& course, const std::vector<Rest>& rests) {
  constexpr std::size_t kFewest = 12, kWanted = 24;
  Blocks cut;
  const auto arrived = static_cast<std::size_t>(std::ranges::count(rests, true, &Rest::arrives));
  const std::size_t pieces = arrived > 0 && arrived < kFewest ? (kWanted + arrived - 1) / arrived : 1;
  for (const Rest& rest : rests) {
    if (rest.arrives) {
      AddPieces(rest, pieces, cut.blocks);
    } else {
      cut.moving += rest.end - rest.begin;
      ++cut.moving_rests;
    }
  }
  for (const Block& block : cut.blocks) cut.usual_rows = std::max(cut.usual_rows, block.end - block.begin);
  cut.left_out = static_cast<std::size_t>(std::ranges::count_if(course.direction, [](int d) { return d != 0; }));
  return cut;
}

Blocks CutMotion(const Course& course, const std::vector<double>& time_s, std::size_t rows, bool joins = false) {
  Blocks cut;
  cut.usual_rows = rows;
  const double usual_s = UsualInterval(time_s);
  const std::size_t n = course.reference.size();
  std::size_t begin = 0, behind_reversal = kBehindReversal;
  for (std::size_t i = 1; i <= n; ++i) {
    const bool moves = course.direction[begin] != 0;
    // A rest has little to tell: its blocks are eight times as long.
    const std::size_t longest = !moves                              ? 8 * rows
                                : behind_reversal < kBehindReversal ? std::max<std::size_t>(1, rows / 8)
                                                                    : rows;
    if (i < n && i - begin < longest && !Parts(course, time_s, usual_s, i, joins)) continue;
    cut.blocks.push_back({begin, i, 0});
    if (moves) cut.widest = std::max(cut.widest, std::abs(course.reference[i - 1] - course.reference[begin]));
    if (moves) ++behind_reversal;
    if (i < n && course.pass[i] != course.pass[i - 1]) behind_reversal = 0;
    begin = i;
  }
  return cut;
}

/// Stops as close as the entries of a table: neighbours can be taken together.
bool AreDense(const Course& course) {
  std::vector<double> way = StepsOf(course.reference);
  for (double& step : way) step = std::abs(step);
  return MedianOf(std::move(way)) < kDense_rad;
}

Blocks CutToAbout(const Course& course, const std::vector<double>& time_s, std::size_t most) {
  std::size_t rows = (course.reference.size() + most - 1) / most;
  Blocks cut = CutMotion(course, time_s, rows);
  for (int tries = 0; cut.blocks.size() > most + most / 4 && tries < 6;
       ++tries) {  // many reversals, many short blocks
    rows += rows / 2 + 1;
    cut = CutMotion(course, time_s, rows);
  }
  return cut;
}

/// As many as were asked for, or where a motion has more pieces than that as few as it has.
Blocks CutToAtMost(const Course& course, const std::vector<double>& time_s, std::size_t most) {
  Blocks cut;
  const std::size_t n = course.reference.size();
  for (const bool joins : {false, true}) {
    for (std::size_t rows = (n + most - 1) / most; rows < 2 * n; rows += rows / 4 + 1) {
      cut = CutMotion(course, time_s, rows, joins);
      if (cut.blocks.size() <= most) return cut;
    }
  }
  return cut;
}

}  // namespace

Blocks CutIntoBlocks(const Course& course, const std::vector<double>& time_s, const MostReadings& wanted,
                     const std::vector<Rest>& rests) {
  const std::size_t most = wanted.count;
  if (!rests.empty()) return CutStops(course, rests);
  const std::size_t n = course.reference.size();
  if (n <= most || (course.stops && !AreDense(course))) {
    Blocks cut;
    for (std::size_t i = 0; i < n; ++i) cut.blocks.push_back({i, i + 1, 0});
    return cut;
  }
  if (wanted.is_stated) return CutToAtMost(course, time_s, most);
  Blocks cut = CutToAbout(course, time_s, most);
  if (HighestOrderKept(cut.widest) < kOrdersWanted && cut.usual_rows > 1) {
    const double more = static_cast<double>(most) * kOrdersWanted * cut.widest / kOneInAHundred;
    cut = CutToAbout(course, time_s, std::min(4 * most, static_cast<std::size_t>(more) + 1));
  }
  return cut;
}

int HighestOrderKept(double widest_rad) {
  return widest_rad > 0.0 ? static_cast<int>(kOneInAHundred / widest_rad) : 0;
}

}  // namespace twinbench::imports
