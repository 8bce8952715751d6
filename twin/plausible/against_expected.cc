#include "twin/plausible/checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "twin/core/lag.h"
#include "twin/core/robust_scale.h"
#include "twin/core/units.h"

namespace twinbench::plausible {
namespace {

constexpr double kSameWay = 0.5;      // of the way that a channel should go, by which it may be off
constexpr double kAnotherSize = 3.0;  // times, either way
constexpr double kGoesLater = 0.75;   // correlation
constexpr std::size_t kMostPairs = 2000, kFarthest = 2000;

/// Indices of the channel's values by set-up, where its nominal value is known.
std::map<int, std::vector<std::size_t>> BySetup(const Channel& channel, const std::vector<double>& nominal) {
  std::map<int, std::vector<std::size_t>> rows;
  for (std::size_t i = 0; i < channel.size(); ++i) {
    if (std::isfinite(nominal[i])) rows[channel.reading[i]->setup].push_back(i);
  }
  return rows;
}

/// Pairs of a set-up between which the nominal value goes half as far as it ever does; an angle an eighth of a turn at most,
/// so that one that goes backwards is told.
void AddFarPairs(const std::vector<std::size_t>& rows, const std::vector<double>& nominal, double least, bool is_angle,
                 std::vector<Pair>& pairs) {
  double low = INFINITY, high = -INFINITY;
  for (const std::size_t i : rows) {
    low = std::min(low, nominal[i]);
    high = std::max(high, nominal[i]);
  }
  const double far = is_angle ? std::min((high - low) / 2.0, units::turn / 8.0) : (high - low) / 2.0;
  if (!(far > least)) return;
  const std::size_t stride = 1 + rows.size() / kMostPairs;
  for (std::size_t a = 0; a < rows.size(); a += stride) {
    for (std::size_t b = a + 1; b < std::min(rows.size(), a + kFarthest); ++b) {
      if (std::abs(nominal[rows[b]] - nominal[rows[a]]) < far) continue;
      pairs.emplace_back(rows[a], rows[b]);
      break;
    }
  }
}

/// By how many readings a channel comes later in every set-up, as a servo does that lags behind its command; nothing where it does not.
std::optional<std::size_t> RowsLater(const Channel& channel, bool is_angle, const std::vector<double>& nominal) {
  std::optional<std::size_t> latest;
  for (const auto& [setup, rows] : BySetup(channel, nominal)) {
    std::vector<double> should, does;
    for (const std::size_t i : rows) {
      should.push_back(nominal[i]);
      const double step = does.empty() ? 0.0 : channel.value[i] - does.back();
      does.push_back(does.empty() ? channel.value[i] : does.back() + (is_angle ? std::remainder(step, units::turn) : step));
    }
    const auto lag = LagOf(should, does);
    if (!lag) return std::nullopt;
    const StraightLine line = LineAtLag(should, does, *lag);
    if (line.correlation < kGoesLater || line.slope < 1.0 / kAnotherSize || line.slope > kAnotherSize) return std::nullopt;
    latest = std::max(latest.value_or(0), *lag);
  }
  return latest;
}

/// Whether a channel goes with what its readings' angles and places say of it: in their order, sense and unit.
void CheckGoesWith(const Channel& channel, const Expected& expected, std::vector<Finding>& findings) {
  if (!expected.nominal) return;
  std::vector<double> nominal;
  for (const Reading* reading : channel.reading) nominal.push_back(expected.nominal(*reading));
  const double least = std::max(kMuch * expected.noise, expected.is_angle ? 0.1 * units::deg : 0.0);
  std::vector<Pair> pairs;
  for (const auto& [setup, rows] : BySetup(channel, nominal)) AddFarPairs(rows, nominal, least, expected.is_angle, pairs);
  if (pairs.size() < kFewestToJudge) return;
  const std::vector<double> should = Between(pairs, nominal), does = Between(pairs, channel.value);
  std::vector<double> times;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const double way = expected.is_angle ? std::remainder(should[k], units::turn) : should[k];
    if (std::abs(way) < 0.5 * least) continue;
    const double off = expected.is_angle ? std::remainder(does[k] - should[k], units::turn) : does[k] - should[k];
    times.push_back(1.0 + off / way);
  }
  const double usual = MiddleOf(times);
  std::vector<double> off = times;
  for (double& one : off) one = std::abs(one - usual);
  const bool of_one_size = MiddleOf(std::move(off)) < kSameWay * std::abs(usual);
  const std::string& name = channel.column->name;
  const bool is_aliased = expected.is_angle && std::abs(usual) > 2.0;  // whole turns are lost
  if (const auto later = of_one_size || is_aliased || !expected.may_lag ? std::nullopt : RowsLater(channel, expected.is_angle, nominal)) {
    findings.push_back({false, fmt::format("{} goes with the angles or places of its readings about {} readings later", name, *later)});
  } else if (!of_one_size || is_aliased) {
    findings.push_back({!expected.is_loose, fmt::format("{} does not go with the angles or places of its readings: are they in "
                                                        "another order or unit?",
                                                        name)});
  } else if (std::abs(usual) < 1.0 / kAnotherSize || std::abs(usual) > kAnotherSize) {
    const bool is_far = std::abs(usual) < 1.0 / kTimes || std::abs(usual) > kTimes;
    findings.push_back(
        {!expected.is_loose || is_far,
         fmt::format("{} goes {:.3g} times as far as its readings' angles or places say: is it in another unit?", name, usual)});
  } else if (usual < 0.0) {
    findings.push_back({!expected.is_loose, fmt::format("{} goes the other way than its readings' angles or places", name)});
  }
}

double SumOfProducts(const std::vector<double>& a, const std::vector<double>& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

constexpr double kNoNoise = 100.0;    // of the noise: nor one that was stated wrong
constexpr double kAsAtRandom = 0.6;   // of what readings taken at random differ by
constexpr double kAlone = 50.0;       // times its scatter: no noise has such tails
constexpr std::size_t kFewestPairs = 20;

/// What a channel leaves of what it should show; itself where nothing is known.
std::vector<double> LeftOf(const Channel& channel, const Expected& expected) {
  if (!expected.nominal) return channel.value;
  std::vector<double> left = channel.value;
  for (std::size_t i = 0; i < channel.size(); ++i) {
    const double nominal = expected.nominal(*channel.reading[i]);
    if (!std::isfinite(nominal)) continue;
    left[i] = expected.is_angle ? std::remainder(left[i] - nominal, units::turn) : left[i] - nominal;
  }
  return left;
}

/// Upper bound of the white noise: the course of a channel and what repeats differ by are in it.
double NoiseBound(const Channel& channel, const std::vector<double>& left) {
  std::vector<double> bounds = {RobustNoiseOnCourse(left)};
  std::vector<double> repeats = Between(Repeats(channel), left);
  if (repeats.size() >= kFewestToJudge) {
    const double middle = MiddleOf(repeats);
    for (double& one : repeats) one -= middle;
    bounds.push_back(RobustDeviation(std::move(repeats)) / std::sqrt(2.0));
  }
  return *std::ranges::min_element(bounds);
}

void CheckSize(const Channel& channel, const Expected& expected, std::vector<Finding>& findings) {
  if (channel.size() < kFewestToJudge) return;
  const std::string& name = channel.column->name;
  const double off_zero = MiddleOf(Sizes(channel.value));
  if (expected.nulled > 0.0 && off_zero > kTimes * expected.nulled)
    findings.push_back({false, fmt::format("{} lies {:.3g} times as far from zero as it is brought: is it in another unit?", name,
                                           off_zero / expected.nulled)});
  const double noise = NoiseBound(channel, LeftOf(channel, expected));
  const bool is_still = expected.noise > 0.0 && noise < expected.noise / kTimes && !(StepOf(channel) > noise);
  const CourseSpread spread = expected.course ? SpreadAbout(channel, expected) : CourseSpread{};
  const bool is_small = spread.shown<spread.expected / kTimes, is_large = spread.shown> spread.expected * kTimes;
  if (spread.expected > 0.0 && (is_small || is_large))
    findings.push_back(
        {is_large || is_still, fmt::format("{} spreads {:.3g} times as far as the scenario says: is it in another unit?", name,
                                           spread.shown / spread.expected)});
  if (is_still)
    findings.push_back(
        {false, fmt::format("{} scatters {:.3g} times as much as the scenario says, at most: is it in another unit, or is "
                            "the noise that is stated not its own?",
                            name, noise / expected.noise)});
}

/// What lies between readings of one place, but for what those that follow each other in the same directions have in common: a reversal.
std::vector<double> BesideReversal(const Channel& channel, const std::vector<Pair>& pairs, std::vector<double> between) {
  std::map<std::pair<int, int>, std::vector<std::size_t>> alike;
  for (std::size_t k = 0; k < pairs.size(); ++k)
    alike[{channel.reading[pairs[k].first]->direction, channel.reading[pairs[k].second]->direction}].push_back(k);
  for (const auto& [directions, rows] : alike) {
    double mean = 0.0;
    for (const std::size_t k : rows) mean += between[k] / static_cast<double>(rows.size());
    for (const std::size_t k : rows) between[k] -= mean;
  }
  return between;
}

/// What is left where a channel was nulled by its axis is what the axis stands beside: from one reading of a place to another both go alike,
/// and its noise makes less of that.
void CheckNulled(const Channel& channel, const Expected& expected, std::vector<Finding>& findings) {
  constexpr double kTimesU = 6.0, kNone = 3.0;  // of a slope: of normal errors, of readings that are in two pairs, one in 10^6 is as large
  const std::vector<Pair> repeats = Repeats(channel);
  if (!(expected.nulled > 0.0) || repeats.size() < kFewestPairs) return;
  std::vector<double> stood;
  for (const Reading* reading : channel.reading) stood.push_back(expected.by_axes(*reading));
  std::vector<double> went = Between(repeats, stood);
  for (double& way : went) way = std::remainder(way, units::turn);
  const std::vector<double> by_axis = BesideReversal(channel, repeats, went),
                            shown = BesideReversal(channel, repeats, Between(repeats, channel.value));
  const double count = static_cast<double>(repeats.size()), squares = SumOfProducts(shown, shown);
  if (!(squares > 0.0 && SumOfProducts(by_axis, by_axis) > 0.0)) return;  // to the last digit the same: nothing goes with anything
  const double slope = SumOfProducts(shown, by_axis) / squares;
  const double left = std::max(SumOfProducts(by_axis, by_axis) - slope * slope * squares, 0.0);
  const double u = std::sqrt(left / count / squares), least = 1.0 - 2.0 * std::pow(expected.nulled_noise, 2) * count / squares;
  if (slope > std::min(least - kTimesU * u, kNone * u) && slope < kAnotherSize + kTimesU * u) return;
  findings.push_back({false, fmt::format("{} goes {:.2g} times as far as its axis from one reading of a place to the next: is it in another order "
                                         "or unit, or of another sign?",
                                         channel.column->name, 1.0 / slope)});
}

void CheckOrdered(const Channel& channel, const Expected& expected, std::vector<Finding>& findings) {
  const std::vector<Pair> repeats = Repeats(channel), neighbours = Neighbours(channel);
  if (!(expected.noise > 0.0) || expected.nominal || std::min(repeats.size(), neighbours.size()) < kFewestPairs) return;
  std::vector<Pair> random;
  constexpr std::size_t kFar = 7919;  // prime: every reading is somebody's second
  for (std::size_t i = 0; i < channel.size(); ++i) {
    const std::size_t other = (i * kFar + channel.size() / 2) % channel.size();
    if (channel.reading[i]->setup == channel.reading[other]->setup) random.emplace_back(i, other);
  }
  const auto differ = [&](const std::vector<Pair>& pairs) { return MiddleOf(Sizes(Between(pairs, channel.value))); };
  const double by_chance = differ(random);
  if (!(by_chance > kMuch * expected.noise) || differ(repeats) < kAsAtRandom * by_chance ||
      differ(neighbours) < kAsAtRandom * by_chance)
    return;
  findings.push_back({by_chance > kNoNoise * expected.noise,
                      fmt::format("{} differs as much between readings of one place, and between neighbours, as between any two, "
                                  "and {:.3g} times its noise: do the values belong to their rows?",
                                  channel.column->name, by_chance / expected.noise)});
}

/// How far the values about one lie from the next: what a course does by itself.
double WayAbout(std::size_t i, const std::vector<double>& left) {
  constexpr std::size_t kAbout = 8;
  std::vector<double> way;
  for (std::size_t k = std::max(i, kAbout) - kAbout; k + 1 < std::min(left.size(), i + kAbout + 1); ++k)
    way.push_back(std::abs(left[k + 1] - left[k]));
  return MiddleOf(std::move(way));
}

void CheckSingleValues(const Channel& channel, const Expected& expected, std::vector<Finding>& findings) {
  if (channel.size() < kFewestPairs) return;
  const std::vector<double> left = LeftOf(channel, expected);
  std::vector<double> unlike(channel.size(), INFINITY);  // the repeat that is most alike
  for (const auto& [first, second] : Repeats(channel)) {
    const double apart = std::abs(left[second] - left[first]);
    unlike[first] = std::min(unlike[first], apart);
    unlike[second] = std::min(unlike[second], apart);
  }
  const double usual = std::max({RobustNoiseOnCourse(left), expected.noise, expected.step, StepOf(channel)});
  if (!(usual > LeastScatterOf(channel))) return;
  std::size_t worst = 0;
  double times = 0.0;
  for (std::size_t i = 1; i + 1 < channel.size(); ++i) {
    const double course = std::abs(left[i + 1] - left[i - 1]), alone = std::abs(left[i] - 0.5 * (left[i + 1] + left[i - 1]));
    if (2.0 * course > alone || std::min(alone, unlike[i]) < kAlone * usual) continue;  // a step, a slope, or of its place
    if (const double here = std::min(alone, unlike[i]) / std::max(usual, WayAbout(i, left)); here > times) times = here, worst = i;
  }
  if (!(times > kAlone)) return;
  findings.push_back(
      {false, fmt::format("{} of reading {} lies {:.3g} times its scatter from its neighbours and from readings of the "
                          "same place",
                          Text(*channel.column, channel.value[worst]), channel.reading[worst]->reading, times)});
}

/// Values in a row that stand elsewhere in the same row, to the last digit: noise of a step and more does not
/// repeat itself.
void CheckCopied(const Channel& channel, const Expected& expected, std::vector<Finding>& findings) {
  constexpr std::size_t kInARow = 20;
  if (!(expected.noise > 0.0)) return;
  const std::vector<double>& value = channel.value;
  std::map<std::pair<double, double>, std::size_t> first;
  std::size_t apart = 0, run = 1, longest = 1, end = 0, of_end = 0;
  for (std::size_t i = 1; i < channel.size(); ++i) {
    const auto [entry, is_new] = first.try_emplace({value[i - 1], value[i]}, i);
    const bool goes_on = !is_new && i - entry->second == apart && value[i] != value[i - 1];
    run = goes_on ? run + 1 : 1;
    apart = i - entry->second;
    if (run > longest) longest = run, end = i, of_end = entry->second;
  }
  if (longest < kInARow) return;
  findings.push_back(
      {false, fmt::format("{} of readings {} to {} is that of readings {} to {} to the last digit: was it copied?",
                          channel.column->name, channel.reading[end - longest]->reading, channel.reading[end]->reading,
                          channel.reading[of_end - longest]->reading, channel.reading[of_end]->reading)});
}

}  // namespace

void CheckAgainst(const Expected& expected, const Channel& channel, std::vector<Finding>& findings) {
  CheckGoesWith(channel, expected, findings);
  CheckSize(channel, expected, findings);
  CheckOrdered(channel, expected, findings);
  CheckNulled(channel, expected, findings);
  CheckCopied(channel, expected, findings);
  const std::size_t before = findings.size();
  CheckSingleValues(channel, expected, findings);
  if (findings.size() == before) CheckRepeatedPlaces(expected, channel, LeftOf(channel, expected), findings);
  if (findings.size() == before) CheckLate(expected, channel, findings);
}

}  // namespace twinbench::plausible
