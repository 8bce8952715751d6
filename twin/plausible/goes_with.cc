#include "twin/plausible/goes_with.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "twin/core/lag.h"
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

}  // namespace

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

}  // namespace twinbench::plausible
