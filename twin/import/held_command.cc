#include "twin/import/held_command.h"

#include <algorithm>
#include <cmath>

#include "twin/core/robust_scale.h"
#include "twin/import/common.h"
#include "twin/import/rests.h"

namespace twinbench::imports {
namespace {

constexpr std::size_t kFewestHeld = 12;
constexpr double kOneLength = 0.7;  // share of the values that are held for as long as the usual one, to a row or a fifth

std::size_t RowsOf(const Rest& rest) { return rest.end - rest.begin; }

bool IsHeldFor(const Rest& rest, double usual_rows) {
  return std::abs(static_cast<double>(RowsOf(rest)) - usual_rows) <= std::max(1.0, 0.2 * usual_rows);
}

/// The values go on in one sense from one to the next, as the steps of a test to and fro do not.
bool GoesOn(const std::vector<Rest>& held, const std::vector<double>& reference) {
  constexpr double kMost = 0.6;
  int same = 0;
  double last = 0.0;
  for (std::size_t k = 1; k < held.size(); ++k) {
    const double step = reference[held[k].begin] - reference[held[k - 1].begin];
    same += step * last > 0.0 ? 1 : 0;
    last = step;
  }
  return same > kMost * static_cast<double>(held.size());
}

/// Of the way that the device goes while a value is held, what it goes in the last third, in the middle of all that it moves in.
double StillGoing(const std::vector<Rest>& held, const std::vector<double>& shown, double turn_rad) {
  const auto way = [&](std::size_t a, std::size_t b) {
    return std::abs(turn_rad > 0.0 ? std::remainder(shown[b] - shown[a], turn_rad) : shown[b] - shown[a]);
  };
  std::vector<double> whole, last;
  for (const Rest& rest : held) {
    whole.push_back(way(rest.begin, rest.end - 1));
    last.push_back(way(rest.end - 1 - RowsOf(rest) / 3, rest.end - 1));
  }
  const double usual = MedianOf(whole);  // at a turning point it hardly moves
  std::vector<double> shares;
  for (std::size_t k = 0; k < whole.size(); ++k) {
    if (whole[k] > 0.0 && whole[k] >= usual) shares.push_back(last[k] / whole[k]);
  }
  return shares.empty() ? 0.0 : MedianOf(shares);
}

}  // namespace

std::vector<std::size_t> FreshRows(const Course& course, const std::vector<double>& shown, double turn_rad) {
  constexpr double kGoesOn = 0.2;
  const std::vector<Rest> rests = RestsOf(course, {}, 0.0);
  std::vector<double> lengths;
  for (const Rest& rest : rests) lengths.push_back(static_cast<double>(RowsOf(rest)));
  if (lengths.size() < kFewestHeld) return {};
  const double usual_rows = MedianOf(lengths);
  std::vector<Rest> held;
  std::ranges::copy_if(rests, std::back_inserter(held), [&](const Rest& rest) { return IsHeldFor(rest, usual_rows); });
  if (static_cast<double>(held.size()) < kOneLength * static_cast<double>(rests.size())) return {};
  if (!GoesOn(held, course.reference) || StillGoing(held, shown, turn_rad) < kGoesOn) return {};
  // The rows of a rest do not hold those in which the value changed, which a speed over several rows calls motion.
  std::vector<std::size_t> fresh;
  std::size_t since = 0;
  const auto most = static_cast<std::size_t>(std::lround(usual_rows)) + 2;
  for (std::size_t i = 0; i < course.reference.size(); ++i, ++since) {
    if (i > 0 && course.reference[i] == course.reference[i - 1] && since < most) continue;
    fresh.push_back(i);
    since = 0;
  }
  return fresh;
}

}  // namespace twinbench::imports
