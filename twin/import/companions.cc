#include "twin/import/companions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "twin/core/lag.h"
#include "twin/import/common.h"

namespace twinbench::imports {
namespace {

constexpr double kOffOne = 0.2, kClosely = 0.9;
constexpr std::size_t kFewestTogether = 8;  // rows: fewer go together by chance

using Series = std::vector<double>;

/// Rows in which all are numbers, evenly fewer of many.
std::vector<Series> CommonRows(const std::vector<const Choice*>& columns) {
  constexpr std::size_t kMost = 6000;
  const std::size_t rows = columns.front()->column->value.size(), step = rows / kMost + 1;
  std::vector<Series> common(columns.size());
  for (std::size_t i = 0; i < rows; i += step) {
    const auto has_row = [i](const Choice* c) { return i < c->column->value.size() && std::isfinite(c->column->value[i]); };
    if (!std::ranges::all_of(columns, has_row)) continue;
    for (std::size_t c = 0; c < columns.size(); ++c) common[c].push_back(columns[c]->column->value[i]);
  }
  return common;
}

double RangeOf(const Series& x) {
  const auto [low, high] = std::ranges::minmax(x);
  return high - low;
}

Series Differences(const Series& a, const Series& b) {
  Series difference;
  for (std::size_t i = 0; i < a.size(); ++i) difference.push_back(b[i] - a[i]);
  return difference;
}

/// From the row before to the row behind; none at the ends.
Series Slopes(const Series& x) {
  Series slopes(x.size(), 0.0);
  for (std::size_t i = 1; i + 1 < x.size(); ++i) slopes[i] = x[i + 1] - x[i - 1];
  return slopes;
}

/// What of the motion of `first` within some rows is repeated by `second` behind it, less the same the other way round: -1 to 1.
double LeadWithin(std::size_t rows, const Series& first, const Series& second) {
  double of_first = 0.0, of_second = 0.0;
  for (std::size_t i = 1; i + rows < first.size(); ++i) {
    of_first += (first[i] - first[i - 1]) * (second[i + rows] - second[i]);
    of_second += (second[i] - second[i - 1]) * (first[i + rows] - first[i]);
  }
  const double both = std::abs(of_first) + std::abs(of_second);
  return both > 0.0 ? (of_first - of_second) / both : 0.0;
}

double Roughness(const Series& x) {
  double sum = 0.0;
  for (std::size_t i = 1; i + 1 < x.size(); ++i) sum += std::pow(x[i + 1] - 2.0 * x[i] + x[i - 1], 2);
  return sum;
}

/// In which share of the rows `other` trembles about a place while `standing` stands still, as a command does at rest.
double TremblesWhileStands(const Series& standing, const Series& other) {
  constexpr std::size_t kFewestAtRest = 5;
  std::size_t trembling = 0, begin = 0;
  for (std::size_t i = 1; i <= standing.size(); ++i) {
    if (i < standing.size() && standing[i] == standing[begin]) continue;
    double way = 0.0;
    for (std::size_t k = begin + 1; k < i; ++k) way += std::abs(other[k] - other[k - 1]);
    if (i - begin >= kFewestAtRest && way > 0.0 && std::abs(other[i - 1] - other[begin]) < 0.5 * way) trembling += i - begin;
    begin = i;
  }
  return static_cast<double>(trembling) / static_cast<double>(standing.size());
}

enum class Order { kFirstLeads, kSecondLeads, kFirstIsSmoother, kSecondIsSmoother, kNotTold };

/// What is behind is off against the motion, by as much as it is fast; behind a step it comes later.
Order OrderOf(const Series& first, const Series& second) {
  constexpr double kSeldomByChance = 4.0, kLeast = 0.2, kSmoother = 9.0;
  const Series off = Differences(first, second);
  Series middle = first;
  for (std::size_t i = 0; i < middle.size(); ++i) middle[i] += 0.5 * off[i];
  const double behind = -LineThrough(Slopes(middle), off).correlation, chance = kSeldomByChance / std::sqrt(static_cast<double>(first.size()));
  if (std::abs(behind) > std::max(kLeast, chance)) return behind > 0.0 ? Order::kFirstLeads : Order::kSecondLeads;
  for (std::size_t rows = 1; chance < 1.0 && 8 * rows < first.size(); rows *= 2) {
    const double lead = LeadWithin(rows, first, second);
    if (std::abs(lead) > std::max(kLeast, chance)) return lead > 0.0 ? Order::kFirstLeads : Order::kSecondLeads;
  }
  const double first_stands = TremblesWhileStands(first, second), second_stands = TremblesWhileStands(second, first);
  if (std::max(first_stands, second_stands) > kLeast && std::abs(first_stands - second_stands) > 0.5 * kLeast)
    return first_stands > second_stands ? Order::kFirstIsSmoother : Order::kSecondIsSmoother;
  const double of_first = Roughness(first), of_second = Roughness(second);
  if (chance < 1.0 && of_second > kSmoother * of_first) return Order::kFirstIsSmoother;
  if (chance < 1.0 && of_first > kSmoother * of_second) return Order::kSecondIsSmoother;
  return Order::kNotTold;
}

bool IsClose(const StraightLine& line, double least_gain = 1.0 - kOffOne) {
  return line.correlation > kClosely && line.slope > least_gain && line.slope < 1.0 + kOffOne;
}

/// Two joints that go alike do not go to the same places.
bool AreAtTheSamePlaces(const Series& first, const Series& difference) {
  constexpr double kOfTheWay = 0.1;
  return std::abs(std::accumulate(difference.begin(), difference.end(), 0.0)) < kOfTheWay * RangeOf(first) * static_cast<double>(difference.size());
}

bool FollowsAtALag(const Series& first, const Series& second) {
  constexpr double kSlowServo = 0.5;  // of the way
  const auto lag = LagOf(first, second);
  return lag && *lag > 0 && IsClose(LineAtLag(first, second, *lag), kSlowServo);
}

/// A third column that is what the two differ by, to its last digit.
bool IsDifference(const Series& third, const Series& difference) {
  constexpr double kRounding = 2e-3;
  const double least = kRounding * RangeOf(third);
  if (!(least > 0.0)) return false;
  const auto is = [&](double sign) {
    for (std::size_t i = 0; i < third.size(); ++i)
      if (std::abs(sign * difference[i] - third[i]) > least) return false;
    return true;
  };
  return is(1.0) || is(-1.0);
}

struct Candidate {
  std::size_t first = 0, second = 0;
  double closeness = 0.0;  // a correlation; beyond 1 of two whose difference is there
};

std::optional<Candidate> CandidateOf(std::size_t a, std::size_t b, const std::vector<Series>& values) {
  constexpr double kLeast = 0.5;  // two sides of a circle go together a quarter of a turn later
  const Series difference = Differences(values[a], values[b]);
  if (std::ranges::all_of(difference, [&](double d) { return d == difference.front(); })) return std::nullopt;
  const StraightLine line = LineThrough(values[a], values[b]);
  if (line.correlation < kLeast) return std::nullopt;
  for (std::size_t c = 0; c < values.size(); ++c)
    if (c != a && c != b && IsDifference(values[c], difference)) return Candidate{a, b, 1.0 + line.correlation};
  if (!AreAtTheSamePlaces(values[a], difference)) return std::nullopt;
  const bool is_pair = IsClose(line) || FollowsAtALag(values[a], values[b]) || FollowsAtALag(values[b], values[a]);
  return is_pair ? std::optional(Candidate{a, b, line.correlation}) : std::nullopt;
}

bool IsRateOf(const Series& rate, const Series& place) {
  return std::abs(LineThrough(Slopes(place), rate).correlation) > kClosely;
}

/// Of those that have a column in common the closest.
std::vector<Candidate> ClosestOf(std::vector<Candidate> all) {
  std::ranges::stable_sort(all, std::ranges::greater(), &Candidate::closeness);
  std::vector<std::size_t> axis;  // of each column that is in a pair: the first column of its group
  const auto group_of = [&axis](std::size_t column) {
    while (axis.size() <= column) axis.push_back(axis.size());
    while (axis[column] != column) column = axis[column];
    return column;
  };
  for (const Candidate& c : all) {
    const std::size_t a = group_of(c.first), b = group_of(c.second);
    axis[std::max(a, b)] = std::min(a, b);
  }
  std::vector<Candidate> closest;
  for (const Candidate& c : all) {
    const auto is_of_same = [&](const Candidate& other) { return group_of(other.first) == group_of(c.first); };
    if (std::ranges::none_of(closest, is_of_same)) closest.push_back(c);
  }
  std::ranges::sort(closest, {}, &Candidate::first);
  return closest;
}

AxisPair PairOf(const Choice& first, const Choice& second, Order order) {
  switch (order) {
    case Order::kFirstLeads: return {&first, &second, "which goes first of two that go together", "which follows it", false};
    case Order::kSecondLeads: return {&second, &first, "which goes first of two that go together", "which follows it", false};
    case Order::kFirstIsSmoother: return {&first, &second, "the smoother one of two that go together", "which goes with it", false};
    case Order::kSecondIsSmoother: return {&second, &first, "the smoother one of two that go together", "which goes with it", false};
    case Order::kNotTold: break;
  }
  return {&first, &second, "the first of two that go together",
          fmt::format("which goes with it; --column 'reference_deg=[{}]' --column 'measured_deg=[{}]' turns them round", second.name, first.name), false};
}

}  // namespace

bool GoTogether(const Column& first, const Column& second) {
  return IsClose(LineThrough(first.value, second.value));
}

std::vector<AxisPair> CompanionsIn(const std::vector<const Choice*>& columns) {
  if (columns.size() < 2 || std::ranges::any_of(columns, [&columns](const Choice* c) { return c->track != columns.front()->track; })) return {};
  const std::vector<Series> values = CommonRows(columns);
  if (values.front().size() < kFewestTogether) return {};
  std::vector<Candidate> all;
  for (std::size_t a = 0; a < columns.size(); ++a) {
    for (std::size_t b = a + 1; b < columns.size(); ++b)
      if (const auto candidate = CandidateOf(a, b, values)) all.push_back(*candidate);
  }
  const std::vector<Candidate> found = ClosestOf(std::move(all));
  std::vector<AxisPair> pairs;
  for (const Candidate& c : found) {
    const bool is_rate = std::ranges::any_of(found, [&](const Candidate& other) {
      return other.first != c.first && (IsRateOf(values[c.first], values[other.first]) || IsRateOf(values[c.second], values[other.second]));
    });
    if (is_rate) continue;
    pairs.push_back(PairOf(*columns[c.first], *columns[c.second], OrderOf(values[c.first], values[c.second])));
    pairs.back().has_difference = c.closeness > 1.0;
  }
  return pairs;
}

}  // namespace twinbench::imports
