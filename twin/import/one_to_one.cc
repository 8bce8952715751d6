#include "twin/import/one_to_one.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/core/errors.h"
#include "twin/core/lag.h"
#include "twin/import/by_speed.h"
#include "twin/import/common.h"
#include "twin/import/follows.h"
#include "twin/import/said.h"
#include "twin/import/unit_names.h"

namespace twinbench::imports {
namespace {

constexpr double kLikeOne = 0.2;  // a gain further from 1 is no error of a scale but another quantity
constexpr double kFollows = 0.5;  // correlation below which a device does not follow at all
constexpr double kOnItsWay = 0.05;  // correlation that all rows have less than those in which it has arrived
constexpr double kFollowsLater = 0.75;  // the same at the best of many lags, where chance has more to offer
constexpr double kLeastGain = 1.0 / 3.0, kLargestGain = 3.0;  // that play, stiction or a slow servo may leave

std::string SumFor(const std::string& shown) {
  return fmt::format("{} = \"[reference column] + [error column]\"", shown);
}

std::string KeysOf(const std::string& column) {
  return BaseOf(column) + "_rad, " + BaseOf(column) + "_arcsec or " + BaseOf(column) + "_mm";
}

void RequireMotion(const std::string& name, const std::string& source, const std::vector<double>& reference) {
  const auto [low, high] = std::ranges::minmax(reference);
  if (low == high)
    throw InputError(source, fmt::format("the reference never moves: {} is {:g} in all {} rows", name, low / UnitAtEnd(name)->to_SI, reference.size()),
                     "a recording in which it goes to three places at least, or another column; for one place from both sides a column "
                     "\"direction\" of 1 and -1, for a drift at one place a clock");
}

void RequireLife(const std::string& name, const std::string& source, const std::vector<double>& shown) {
  const auto [low, high] = std::ranges::minmax(shown);
  if (low == high)
    throw InputError(source, fmt::format("{} is {:g} in all {} rows: the channel is dead", name, low / UnitAtEnd(name)->to_SI, shown.size()),
                     "another column");
}

/// Another unit and a gear leave a line; what does not is the device's own.
bool IsOwnGain(const Following& following) {
  const bool is_like_one = std::abs(following.gain - 1.0) <= kLikeOne;
  return is_like_one || (following.gain > kLeastGain && following.gain < kLargestGain && !following.is_line);
}

bool FollowsLater(const Following& now, const Following& later) {
  constexpr double kClearly = 0.1;
  return now.correlation > -kFollows && later.rows_later > 0 && later.correlation > std::max(kFollowsLater, now.correlation + kClearly) &&
         IsOwnGain(later);
}

std::string GainText(double gain) {
  return std::abs(gain - 1.0) <= kLikeOne ? "" : fmt::format("; it goes {:.3g} times as far, on no line: play, stiction or a speed that it does not reach", gain);
}

/// A clock of whole seconds that is seconds late counts perhaps milliseconds, whatever its name says.
std::string LaterText(double step_s, double later_s) {
  constexpr double kLong_s = 10.0;
  if (step_s == 1.0 && later_s >= kLong_s) return fmt::format(" ({:.3g} s; {:.3g} s if the clock counts ms: --column 'time_ms=its column')", later_s, 1e-3 * later_s);
  return fmt::format(" ({:.3g} s)", later_s);
}

std::string LagText(const std::string& name, const std::string& reference, const Session& session, const Following& later) {
  const double step_s = MedianOf(StepsOf(session.time_s)), later_s = static_cast<double>(later.rows_later) * step_s;
  return fmt::format("{} follows {} about {} rows{} later{}", name, reference, later.rows_later,
                     session.has_clock ? LaterText(step_s, later_s) : "", GainText(later.gain));
}

/// Less than that is what stops short by a part of its last step.
HowItFollows ByItsSpeed(const std::string& name, const std::string& by, const Session& session, const std::vector<double>& reference) {
  constexpr double kLeastRows = 0.3;
  const double rows = session.has_clock ? 0.0 : RowsBehindBySpeed(reference, session.value.at(name));
  if (!(rows > kLeastRows)) return {};
  return {fmt::format("{} is behind {} by its speed, about {:.2g} rows", name, by, rows), true};
}

[[noreturn]] void RefuseGain(const std::string& name, const std::string& reference, double gain, const Map& map) {
  const std::string meaning = MeaningOfGain(gain);
  throw InputError(
      NameOf(map, name), fmt::format("{} follows {} times {:.6g}{}", name, reference, gain, meaning.empty() ? "" : ": " + meaning),
      std::abs(gain + 1.0) <= kLikeOne
          ? fmt::format("the same sense: {} = \"-{}\"", KeyOf(map, name), ExpressionOf(map, name))
          : fmt::format("the same unit and sense: {} = \"...\" in the unit it has, or {} = \"{} / {:.6g}\"", KeysOf(name), KeyOf(map, name),
                        ExpressionOf(map, name), NominalGain(gain)));
}

/// The whole number of turns that one side makes for one of the other; 0: it is none.
double GearOf(double ratio) {
  constexpr double kExact = 5e-3, kNearlyWhole = 0.05, kLargest = 400.0;  // any large ratio is within 5e-3 of a whole number
  const double whole = std::round(ratio), off = std::abs(ratio - whole);
  const bool is_gear = whole >= 2.0 && whole <= kLargest && off < std::min(kExact * whole, kNearlyWhole) && MeaningOfGain(ratio).empty();
  return is_gear ? whole : 0.0;
}

Alignment AgainstReference(const std::string& name, const std::string& by, const Map& map) {
  return {1.0, -1.0,
          fmt::format("{} counts against {}: taken with the other sign, as --column '{}=-{}' has it", name, by,
                      KeyOf(map, name), ExpressionOf(map, name))};
}

}  // namespace

Alignment AlignmentOf(const Session& session, const std::vector<double>& reference, const BenchFormat& bench,
                      const Map& map) {
  const std::string &name = bench.compared->shown, &by = bench.compared->reference;
  const auto [low, high] = std::ranges::minmax(session.value.at(name));
  if (low == high) return {};
  const Following now = FollowingOf(reference, session.value.at(name));
  if (!now.is_line) return {};
  if (std::abs(now.gain + 1.0) <= kLikeOne) return AgainstReference(name, by, map);
  const double size = std::abs(now.gain), sense = now.gain < 0.0 ? -1.0 : 1.0;
  const std::string against = sense < 0.0 ? ", in the other sense" : "";
  if (const double gear = GearOf(size); gear > 0.0)
    return {
        1.0, sense / gear,
        fmt::format(
            "{0} goes {1:g} times as far as {2}{3}: taken as a motor in front of a gear {1:g}:1 and divided by it",
            name, gear, by, against)};
  if (const double gear = GearOf(1.0 / size); gear > 0.0)
    return {
        1.0 / gear, sense,
        fmt::format(
            "{0} goes {1:g} times as far as {2}{3}: taken as a motor in front of a gear {1:g}:1 and divided by it",
            by, gear, name, against)};
  return {};
}

HowItFollows RequireOneToOne(const Session& session, const std::vector<double>& reference, bool one_place, const BenchFormat& bench,
                            const Map& map) {
  const std::string &name = bench.compared->shown, &by = bench.compared->reference;
  const std::vector<double>& shown = session.value.at(name);
  RequireLife(name, NameOf(map, name), shown);
  if (one_place) return {};
  RequireMotion(by, NameOf(map, by), reference);
  const Following now = FollowingOf(reference, shown);
  constexpr double kAtOnce = 0.9;  // correlation beyond which nothing can come so much later that it would tell
  const bool goes_so_far = std::abs(now.gain - 1.0) <= kLikeOne;
  // Without a clock nobody knows yet that a device was on its way in the rows in which a command waits for it.
  const bool was_on_its_way = !session.has_clock && LineThrough(reference, shown).correlation < now.correlation - kOnItsWay;
  if (goes_so_far && now.correlation > kAtOnce && !was_on_its_way) return ByItsSpeed(name, by, session, reference);
  const Following later = FollowingLater(reference, shown);
  if (FollowsLater(now, later) || (was_on_its_way && later.rows_later > 0 && IsOwnGain(later))) return {LagText(name, by, session, later), true};
  if (goes_so_far && now.correlation > kFollows) return ByItsSpeed(name, by, session, reference);
  if (std::abs(now.correlation) < kFollows)
    throw InputError(NameOf(map, name), fmt::format("{} does not follow {} (correlation {:.2f}, and at no lag more than {:.2f})", name, by, now.correlation,
                                                    std::max(now.correlation, later.correlation)),
                     "columns of the same axis; of an error use " + SumFor(name));
  if (!IsOwnGain(now)) RefuseGain(name, by, now.gain, map);
  return {fmt::format("{} follows {}{}", name, by, GainText(now.gain))};
}

}  // namespace twinbench::imports
