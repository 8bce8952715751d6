#include "twin/import/pushed.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "twin/core/rounding.h"
#include "twin/import/common.h"

namespace twinbench::imports {
namespace {

constexpr std::size_t kFewestOfARest = 12;  // of a rest

/// Two sides of some values.
struct Sides {
  double low = 0.0, high = 0.0;  // means
  double within = 0.0;           // mean square about the own one
  double share = 0.0;            // of values on the high one

  double Middle() const { return 0.5 * (low + high); }
  double Apart() const { return high - low; }
};

Sides SidesAbout(const std::vector<double>& values, double middle) {
  double sum[2] = {}, squares[2] = {}, count[2] = {};
  for (const double v : values) {
    const int side = v > middle ? 1 : 0;
    sum[side] += v;
    squares[side] += v * v;
    count[side] += 1.0;
  }
  const double low = sum[0] / std::max(1.0, count[0]), high = sum[1] / std::max(1.0, count[1]);
  const double within = squares[0] - count[0] * low * low + squares[1] - count[1] * high * high;
  const auto all = static_cast<double>(values.size());
  return {low, high, within / all, count[1] / all};
}

/// Of a level distribution what is left about the means of its halves is a quarter of the variance, of a sine 0.19,
/// of normal noise 0.36.
constexpr double kLevel = 0.25, kLeft = 0.17;

/// Where values lie on two sides: what is left about their means is a small part of their variance. Neighbouring
/// counts of a display are no sides.
/// @param most  Of the variance, that is left.
std::optional<Sides> TwoSides(const std::vector<double>& values, double most) {
  constexpr int kRounds = 20;
  constexpr double kCounts = 1.5;
  if (values.size() < kFewestOfARest) return {};
  const auto [lowest, highest] = std::ranges::minmax(values);
  Sides sides = SidesAbout(values, 0.5 * (lowest + highest));
  for (int round = 0; round < kRounds; ++round) sides = SidesAbout(values, sides.Middle());
  const double between = sides.share * (1.0 - sides.share) * std::pow(sides.Apart(), 2);
  const double step = CommonStep(Eigen::Map<const Eigen::VectorXd>(values.data(), std::ssize(values)));
  return sides.within < most * (sides.within + between) && sides.Apart() > kCounts * step ? std::optional(sides)
                                                                                          : std::nullopt;
}

/// Rests at one place, and the error in each row of the recording.
struct Place {
  std::vector<Rest> rests;
  const std::vector<double>& error;

  std::vector<double> SecondHalves() const {
    std::vector<double> values;
    for (const Rest& rest : rests) {
      for (std::size_t i = (rest.begin + rest.end) / 2; i < rest.end; ++i) values.push_back(error[i]);
    }
    return values;
  }

  /// Without the rows in which the device was still far beyond the sides, on its way.
  Place Arrived(const Sides& sides) const {
    Place arrived{rests, error};
    for (Rest& rest : arrived.rests) {
      while (rest.begin < rest.end && std::abs(error[rest.begin] - sides.Middle()) > sides.Apart()) ++rest.begin;
    }
    return arrived;
  }

  std::vector<double> Values() const {
    std::vector<double> values;
    for (const Rest& rest : rests)
      values.insert(values.end(), error.begin() + std::ptrdiff_t(rest.begin),
                    error.begin() + std::ptrdiff_t(rest.end));
    return values;
  }

  /// By rest, in its last part.
  std::vector<int> Changes(double middle, double part = 1.0) const {
    std::vector<int> changes;
    for (const Rest& rest : rests) {
      int count = 0;
      const auto rows = static_cast<double>(rest.end - rest.begin);
      for (std::size_t i = rest.end - static_cast<std::size_t>(part * rows) + 1; i < rest.end; ++i)
        count += (error[i] > middle) != (error[i - 1] > middle) ? 1 : 0;
      changes.push_back(count);
    }
    return changes;
  }
};

/// Pushed there and back twice in one rest, and it stays where it is pushed for longer than chance would have it.
std::optional<Sides> SidesOf(const Place& place) {
  constexpr int kChanges = 4, kLate = 2;  // what only swings about its place has come to rest by then
  const std::vector<double> values = place.Values();
  const std::optional<Sides> sides = TwoSides(values, kLeft);
  if (!sides) return {};
  const std::vector<int> changes = place.Changes(sides->Middle());
  double all = 0.0;
  for (const int count : changes) all += count;
  const double by_chance = 2.0 * sides->share * (1.0 - sides->share) * static_cast<double>(values.size());
  const bool goes_on = std::ranges::max(place.Changes(sides->Middle(), 0.5)) >= kLate;
  return goes_on && std::ranges::max(changes) >= kChanges && all < 0.5 * by_chance ? sides : std::nullopt;
}

/// A device that lags behind is pushed forwards. Where nobody pushes it, it is half way, or goes from one side to
/// the other with the noise: these rows are left out.
void Add(const Rest& rest, const std::vector<double>& error, const Sides& sides, Pushed& pushed) {
  constexpr double kHalfWay = 0.1;      // of the way from one to the other, about its middle
  constexpr std::size_t kShortest = 3;  // rows of a stay
  const auto side_at = [&](std::size_t i) {
    const double beyond = error[i] - sides.Middle();
    return std::abs(beyond) < kHalfWay * sides.Apart() ? 0 : beyond > 0.0 ? -1 : 1;
  };
  bool is_new = true;
  for (std::size_t i = rest.begin, end = i; i < rest.end; i = end) {
    while (end < rest.end && side_at(end) == side_at(i)) ++end;
    if (side_at(i) == 0 || end - i < kShortest) continue;
    is_new = is_new || side_at(i) != pushed.direction.back();
    const int pass = pushed.pass.empty() ? 0 : pushed.pass.back() + (is_new ? 1 : 0);
    for (std::size_t k = i; k < end; ++k) pushed.rows.push_back(k);
    pushed.direction.resize(pushed.rows.size(), side_at(i));
    pushed.pass.resize(pushed.rows.size(), pass);
    is_new = false;
  }
}

/// From rest to rest; 0: all are at one place.
double UsualWay(const Course& course, const std::vector<Rest>& rests) {
  std::vector<double> ways;
  for (std::size_t k = 1; k < rests.size(); ++k) {
    const double way = std::abs(course.reference[rests[k].begin] - course.reference[rests[k - 1].begin]);
    if (way > 0.0) ways.push_back(way);
  }
  return MedianOf(std::move(ways));
}

std::vector<double> ErrorsOf(const Course& course, const std::vector<double>& shown, double turn_rad) {
  std::vector<double> error;
  const double last = shown.back() - course.reference.back();  // near which no turn ends
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const double e = shown[i] - course.reference[i] - last;
    error.push_back(turn_rad > 0.0 ? std::remainder(e, turn_rad) : e);
  }
  return error;
}

}  // namespace

Pushed PushedIn(const Course& course, const std::vector<Rest>& rests, const std::vector<double>& shown,
                double turn_rad) {
  constexpr double kMuch = 0.25;  // a device that goes beyond its place and back by so much of the way that it came swings
  const double usual_way = UsualWay(course, rests);
  const std::vector<double> error = ErrorsOf(course, shown, turn_rad);
  std::map<double, Place> places;
  for (const Rest& rest : rests) {
    if (rest.end - rest.begin >= kFewestOfARest)
      places.try_emplace(course.reference[rest.begin], Place{{}, error}).first->second.rests.push_back(rest);
  }
  std::map<std::size_t, std::pair<Rest, Sides>> kept;  // in the order of time
  for (const auto& [at, place] : places) {
    const std::optional<Sides> rough = TwoSides(place.SecondHalves(), kLevel);
    if (!rough) continue;
    const Place arrived = place.Arrived(*rough);
    const std::optional<Sides> sides = SidesOf(arrived);
    if (!sides || (usual_way > 0.0 && sides->Apart() > kMuch * usual_way)) continue;
    for (const Rest& rest : arrived.rests) kept.try_emplace(rest.begin, rest, *sides);
  }
  // Who pushes does so in most rests: a few of many that look so are counts of a display.
  constexpr std::size_t kOneOf = 10;
  if (kOneOf * kept.size() < rests.size()) return {};
  Pushed pushed;
  for (const auto& [begin, rest] : kept) Add(rest.first, error, rest.second, pushed);
  return pushed;
}

}  // namespace twinbench::imports
