#include "twin/plausible/checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "twin/core/robust_scale.h"
#include "twin/core/units.h"

namespace twinbench::plausible {
namespace {

constexpr double kTimesOthers = 8.0;  // nor a tail of any noise that has a standard deviation
constexpr double kTimesNext = 3.0;    // times its neighbours: a spike has a course
constexpr std::size_t kNear = 3;      // on either side

using RowsOfPass = std::vector<std::size_t>;

std::vector<RowsOfPass> Passes(const Channel& channel) {
  std::map<std::tuple<Phase, int, int>, RowsOfPass> passes;
  for (std::size_t i = 0; i < channel.size(); ++i) {
    const Reading& r = *channel.reading[i];
    passes[{r.phase, r.setup, r.pass}].push_back(i);
  }
  std::vector<RowsOfPass> all;
  for (auto& [pass, rows] : passes) all.push_back(std::move(rows));
  return all;
}

/// A row, and which visit of its place it belongs to: rows of one visit may lie beside each other on their way.
struct Visitor {
  std::size_t row = 0;
  int visit = 0;
};

int VisitsOf(const std::vector<Visitor>& visitors) {
  int visits = 1;
  for (std::size_t i = 1; i < visitors.size(); ++i) visits += visitors[i].visit != visitors[i - 1].visit ? 1 : 0;
  return visits;
}

/// Each value less the middle of those of other visits of its place; NaN: there are fewer than two visits, and nobody
/// knows which is wrong. A position of passes of another length is another place.
std::vector<double> BesideOthers(const Channel& channel, const std::vector<RowsOfPass>& passes,
                                 const std::vector<double>& left, bool is_angle) {
  std::map<std::tuple<Phase, int, int, std::size_t>, std::vector<Visitor>> places;
  int visit = 0;
  for (const RowsOfPass& pass : passes) {
    ++visit;
    for (std::size_t k = 0; k < pass.size(); ++k) {
      const Reading& r = *channel.reading[pass[k]];
      if (k > 0 && r.position != channel.reading[pass[k - 1]]->position) ++visit;
      places[{r.phase, r.setup, r.position, pass.size()}].push_back({pass[k], visit});
    }
  }
  std::vector<double> beside(channel.size(), kNaN);
  for (const auto& [place, visitors] : places) {
    if (VisitsOf(visitors) < 3) continue;
    for (const auto& [i, own] : visitors) {
      std::vector<double> off;
      for (const auto& [k, other] : visitors)
        if (other != own) off.push_back(is_angle ? std::remainder(left[i] - left[k], units::turn) : left[i] - left[k]);
      beside[i] = MiddleOf(std::move(off));
    }
  }
  return beside;
}

/// Less the middle of those next to it: a pass may lie elsewhere as a whole, and drift. Not the first and the last:
/// what turns round there may not have come to rest.
void TakeNeighbours(const RowsOfPass& pass, std::vector<double>& beside) {
  std::vector<double> course;
  for (const std::size_t i : pass) course.push_back(beside[i]);
  for (std::size_t k = 0; k < pass.size(); ++k) {
    std::vector<double> near;
    for (std::size_t n = std::max(k, kNear) - kNear; n < std::min(pass.size(), k + kNear + 1); ++n)
      if (n != k && std::isfinite(course[n])) near.push_back(course[n]);
    const bool is_within = k > 0 && k + 1 < pass.size() && near.size() > kNear;
    beside[pass[k]] = is_within ? course[k] - MiddleOf(std::move(near)) : kNaN;
  }
}

/// Of the two next to it in its pass, the larger.
double NextTo(const RowsOfPass& pass, std::size_t k, const std::vector<double>& beside) {
  double largest = 0.0;
  if (k > 0 && std::isfinite(beside[pass[k - 1]])) largest = std::abs(beside[pass[k - 1]]);
  if (k + 1 < pass.size() && std::isfinite(beside[pass[k + 1]]))
    largest = std::max(largest, std::abs(beside[pass[k + 1]]));
  return largest;
}

/// Means of a place, of passes in either direction.
struct BothWays {
  double sum[2] = {0.0, 0.0};
  int count[2] = {0, 0};
};

/// By how much places differ between passes of either direction if every value is that of the place so many readings before; NaN: too
/// few have both. Where nobody knows what it should show, about what each set-up has everywhere, which may be a reversal.
double ApartBothWays(const Expected& expected, const Channel& channel, const std::vector<RowsOfPass>& passes, int later) {
  const auto left = [&](const Reading& place, double value) {
    const double off = expected.nominal ? value - expected.nominal(place) : value;
    return expected.nominal && expected.is_angle ? std::remainder(off, units::turn) : off;
  };
  std::map<std::tuple<Phase, int, std::size_t>, std::map<int, BothWays>> set_ups;
  for (const RowsOfPass& pass : passes) {
    const auto rows = static_cast<int>(pass.size());
    for (int k = std::max(0, -later); k < std::min(rows, rows - later); ++k) {
      const Reading& r = *channel.reading[pass[static_cast<std::size_t>(k)]];
      BothWays& place = set_ups[{r.phase, r.setup, pass.size()}][r.position];
      const int way = r.direction > 0 ? 0 : 1;
      place.sum[way] += left(r, channel.value[pass[static_cast<std::size_t>(k + later)]]), ++place.count[way];
    }
  }
  std::vector<double> apart;
  for (const auto& [set_up, places] : set_ups) {
    std::vector<double> own;
    for (const auto& [position, at] : places)
      if (at.count[0] > 0 && at.count[1] > 0) own.push_back(at.sum[0] / at.count[0] - at.sum[1] / at.count[1]);
    const double middle = expected.nominal ? 0.0 : MiddleOf(own);
    for (const double one : own) apart.push_back(one - middle);
  }
  return apart.size() < kFewestToJudge ? kNaN : MiddleOf(Sizes(std::move(apart)));
}

}  // namespace

void CheckRepeatedPlaces(const Expected& expected, const Channel& channel, const std::vector<double>& left,
                         std::vector<Finding>& findings) {
  const std::vector<RowsOfPass> passes = Passes(channel);
  std::vector<double> beside = BesideOthers(channel, passes, left, expected.is_angle), sizes;
  for (const RowsOfPass& pass : passes) TakeNeighbours(pass, beside);
  for (const double one : beside)
    if (std::isfinite(one)) sizes.push_back(std::abs(one));
  if (sizes.size() < kFewestToJudge) return;
  const double usual =
      std::max({RobustDeviation(std::move(sizes)), expected.noise, expected.step, expected.nulled, StepOf(channel)});
  if (!(usual > LeastScatterOf(channel))) return;
  double times = kTimesOthers;
  std::size_t worst = channel.size();
  for (const RowsOfPass& pass : passes) {
    for (std::size_t k = 0; k < pass.size(); ++k) {
      const double here = std::abs(beside[pass[k]]);
      if (here > times * usual && here > kTimesNext * NextTo(pass, k, beside))
        times = here / usual, worst = pass[k];
    }
  }
  if (worst == channel.size()) return;
  findings.push_back(
      {false, fmt::format("{} of reading {} lies {:.3g} times the scatter from all others of its place",
                          Text(*channel.column, channel.value[worst]), channel.reading[worst]->reading, times)});
}

void CheckLate(const Expected& expected, const Channel& channel, std::vector<Finding>& findings) {
  constexpr double kTimesShifted = 4.0, kTimesNoise = 5.0;
  const auto in_motion = [](const Reading* r) { return std::isfinite(r->velocity_rad_s) && r->velocity_rad_s != 0.0; };
  if (expected.course || (expected.may_lag && std::ranges::any_of(channel.reading, in_motion))) return;  // they tell by themselves
  const std::vector<RowsOfPass> passes = Passes(channel);
  const double apart = ApartBothWays(expected, channel, passes, 0);
  const double least = std::max({expected.noise, expected.step, StepOf(channel), LeastScatterOf(channel)});
  if (!(apart > kTimesNoise * least)) return;
  for (const int later : {1, -1}) {
    const double shifted = ApartBothWays(expected, channel, passes, later);
    if (!(apart > kTimesShifted * shifted)) continue;
    findings.push_back(
        {false, fmt::format("{} is the same in both directions, to {:.3g} of what it differs by, if it is that of the reading {}: "
                            "is the instrument late by one, or has it a latency of that time?",
                            channel.column->name, shifted / apart, later > 0 ? "before" : "behind")});
  }
}

}  // namespace twinbench::plausible
