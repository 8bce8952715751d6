#include "twin/import/rests.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "twin/core/robust_scale.h"
#include "twin/import/common.h"

namespace twinbench::imports {
namespace {

constexpr std::size_t kFewestToJudge = 10;  // rows of a rest

/// From where it is last, by the nearest way.
std::vector<double> FromItsEnd(std::span<const double> shown, double turn_rad) {
  std::vector<double> way;
  for (const double x : shown) way.push_back(turn_rad > 0.0 ? std::remainder(x - shown.back(), turn_rad) : x - shown.back());
  return way;
}

double MeanOfRows(const std::vector<double>& values, std::size_t begin, std::size_t end) {
  double sum = 0.0;
  for (std::size_t i = begin; i < end; ++i) sum += values[i];
  return sum / static_cast<double>(end - begin);
}

double DeviationOf(const std::vector<double>& values, std::size_t begin, std::size_t end) {
  const double mean = MeanOfRows(values, begin, end);
  double sum = 0.0;
  for (std::size_t i = begin; i < end; ++i) sum += (values[i] - mean) * (values[i] - mean);
  return std::sqrt(sum / static_cast<double>(end - begin));
}

/// @param step  Of the command before this rest [rad].
void Judge(std::span<const double> shown, double turn_rad, double step, Rest& rest) {
  const std::vector<double> way = FromItsEnd(shown, turn_rad);
  const std::size_t rows = way.size(), tenth = std::max<std::size_t>(3, rows / 10);
  const std::vector<double> last(way.end() - static_cast<std::ptrdiff_t>(tenth), way.end());
  const double spread = DeviationOf(way, rows - tenth, rows);
  const double goes_on = std::abs(MeanOfRows(way, rows - tenth, rows) - MeanOfRows(way, rows - 2 * tenth, rows - tenth));
  // Of a steady motion the tenths are sqrt(12) deviations apart; a device that shakes about its place is not on its way.
  rest.arrives = goes_on <= 0.02 * step || goes_on <= 2.0 * spread;
  if (!rest.arrives) return;
  const double end = MedianOf(last), stands = 6.0 * std::max(RobustNoiseOnCourse(way), spread);
  std::size_t from = rows - tenth;
  while (from > 0 && std::abs(way[from - 1] - end) <= stands) --from;
  rest.stands = std::max(rest.stands, rest.begin + from);
}

}  // namespace

std::vector<Rest> RestsOf(const Course& course, const std::vector<double>& shown, double turn_rad) {
  std::vector<Rest> rests;
  const std::size_t n = course.reference.size();
  for (std::size_t i = 0; i < n;) {
    std::size_t end = i;
    while (end < n && course.direction[end] == 0) ++end;
    if (end > i) rests.push_back({i, end, i + (end - i) / 3, true});
    i = std::max(end, i + 1);
  }
  if (shown.empty()) return rests;
  for (std::size_t k = 0; k < rests.size(); ++k) {
    Rest& rest = rests[k];
    if (rest.end - rest.begin < kFewestToJudge) continue;
    const double step = k == 0 ? 0.0 : std::abs(course.reference[rest.begin] - course.reference[rests[k - 1].end - 1]);
    const std::span rows(shown.begin() + static_cast<std::ptrdiff_t>(rest.begin), rest.end - rest.begin);
    if (step > 0.0) Judge(rows, turn_rad, step, rest);
  }
  return rests;
}

std::size_t RowsOnTheWay(std::vector<double> shown, double place_rad, double turn_rad) {
  constexpr double kShareOfTurn = 0.05, kTimesLater = 3.0, kShareOfPlace = 0.5;
  const double far_rad = place_rad == 0.0 ? kShareOfTurn * turn_rad : std::min(kShareOfTurn * turn_rad, kShareOfPlace * std::abs(place_rad));
  const std::size_t half = shown.size() / 2;
  Unwrap(turn_rad, shown);
  const double place = MedianOf({shown.begin() + static_cast<std::ptrdiff_t>(half), shown.end()});
  std::vector<double> off;
  for (const double x : shown) off.push_back(std::abs(x - place));
  const double later = *std::max_element(off.begin() + static_cast<std::ptrdiff_t>(half), off.end());
  std::size_t rows = 0;
  if (off.front() < std::max(far_rad, kTimesLater * later)) return rows;
  while (rows < half && off[rows] > later) ++rows;
  return rows;
}

}  // namespace twinbench::imports
