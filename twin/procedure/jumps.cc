#include "twin/procedure/jumps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <span>

#include "twin/core/device_fault.h"
#include "twin/core/distributions.h"

namespace twinbench::procedure {
namespace {

using ValueIn = std::function<double(const Reading&)>;

/// One place in two passes.
struct Repeat {
  double before, again;
  int reading;  // the earlier
  double Differs() const { return again - before; }
  double Adds() const { return again + before; }
};

/// One entry a place that both have, this reading's pass and the one before it, in the order of the later.
std::vector<Repeat> RepeatsOf(const ValueIn& value, const Reading& reading, const std::vector<Reading>& kept) {
  const auto is_of = [&](const Reading& r, int pass) {
    return r.setup == reading.setup && r.phase == reading.phase && r.pass == pass;
  };
  std::map<int, const Reading*> before;
  std::vector<Repeat> repeats;
  const auto add = [&](const Reading& again) {
    const auto first = before.find(again.position);
    if (first != before.end()) repeats.push_back({value(*first->second), value(again), first->second->reading});
  };
  for (const Reading& r : kept)
    if (is_of(r, reading.pass - 1)) before[r.position] = &r;
  for (const Reading& r : kept)
    if (is_of(r, reading.pass) && r.reading != reading.reading) add(r);
  add(reading);
  return repeats;
}

struct Level {
  double mean = 0.0, squares = 0.0;  // about the mean
};

/// Of those from first to before end, or of all others.
Level LevelOf(const std::vector<Repeat>& repeats, std::size_t first, std::size_t end, bool others) {
  double sum = 0.0, squares = 0.0, count = 0.0;
  for (std::size_t k = 0; k < repeats.size(); ++k) {
    if ((k >= first && k < end) == others) continue;
    const double differs = repeats[k].Differs() - repeats[0].Differs();  // small, so that squares keep their digits
    sum += differs, squares += differs * differs, count += 1.0;
  }
  return {sum / count, std::max(0.0, squares - sum * sum / count)};
}

/// Median size about the median, in which a few that have jumped count for nothing; nor does the last, which is
/// asked about.
double ScatterBefore(const std::vector<Repeat>& repeats) {
  if (repeats.size() < 2) return 0.0;
  std::vector<double> differ;
  for (std::size_t k = 0; k + 1 < repeats.size(); ++k) differ.push_back(repeats[k].Differs());
  const double median = Median(differ);
  for (double& one : differ) one = std::abs(one - median);
  return Median(std::move(differ));
}

/// What is left of the axes' own way where the column goes along with them.
double Left(const ClaimedColumn& claim, const Reading& reading) {
  const double value = ValueOf(claim, reading);
  if (!claim.follows) return value;
  const double left = value - claim.follows(reading);
  return claim.is_angle ? std::remainder(left, units::turn) : left;
}

/// Of places in two passes: 1, they show the same in both; -1, the other way round; 0, neither is sure.
int WayRound(std::span<const Repeat> places, double noise) {
  constexpr double kTimes = 8.0, kTimesNoise = 10.0;  // root mean squares
  double differs = 0.0, adds = 0.0, mean_differs = 0.0, mean_adds = 0.0;
  const auto count = static_cast<double>(places.size());
  for (const Repeat& one : places) mean_differs += one.Differs() / count, mean_adds += one.Adds() / count;
  for (const Repeat& one : places) {
    differs += std::pow(one.Differs() - mean_differs, 2);
    adds += std::pow(one.Adds() - mean_adds, 2);
  }
  const double least = kTimesNoise * std::sqrt(2.0 * count) * noise;
  const auto rules = [&](double one, double other) { return std::sqrt(one) > std::max(kTimes * std::sqrt(other), least); };
  return rules(adds, differs) - rules(differs, adds);
}

}  // namespace

void RequireNoJump(const std::vector<ClaimedColumn>& claims, const Reading& reading,
                   const std::vector<Reading>& kept) {
  constexpr std::size_t kFewest = 2;                   // of those that show it otherwise, and of the others
  constexpr std::size_t kFewestAboutThatCameBack = 6;  // by fewer chance says too often that it has
  constexpr double kTimesScatter = 8.0;
  for (const ClaimedColumn& claim : claims) {
    if (!claim.is_of_place || !(claim.noise > 0.0)) continue;
    const std::vector<Repeat> repeats =
        RepeatsOf([&](const Reading& r) { return ValueOf(claim, r); }, reading, kept);
    const std::size_t all = repeats.size();
    const auto require = [&](std::size_t first, std::size_t end) {
      const Level one = LevelOf(repeats, first, end, false), other = LevelOf(repeats, first, end, true);
      const double jump = std::abs(other.mean - one.mean);
      const double scatter = std::sqrt((one.squares + other.squares) / static_cast<double>(all - 2));
      if (!(jump > std::max(AllowedAtPlace(claim), kTimesScatter * scatter))) return;
      throw DeviceFault(
          FaultKind::kChanged, "instruments",
          fmt::format(
              "show {} by {:.4g} (SI) otherwise against the pass before at the places of readings {} to {} than at "
              "the others: a zero, a mirror or the mounting jumped, in this pass or the one before; measure "
              "mounting "
              "{} again, in another run",
              claim.column.name, jump, repeats[first].reading, repeats[end - 1].reading, reading.setup));
    };
    for (std::size_t first = kFewest; first + kFewest <= all; ++first) require(first, all);
    if (all < kFewestAboutThatCameBack) continue;
    for (std::size_t first = 1; first + kFewest < all; ++first) require(first, all - 1);
  }
}

void RequireNotReversed(const ClaimedColumn& a, const ClaimedColumn* less, const Reading& reading,
                        const std::vector<Reading>& kept) {
  constexpr std::size_t kPlaces = 6;  // what repeats nowhere is by chance the other way round once in 30 000 times
  constexpr std::size_t kPart = 3;    // beside as many that are as before
  const auto value = [&](const Reading& r) { return ValueOf(a, r) - (less ? ValueOf(*less, r) : 0.0); };
  const std::vector<Repeat> repeats = RepeatsOf(value, reading, kept);
  const std::size_t all = repeats.size();
  if (all < kPlaces) return;
  const double noise = std::hypot(a.noise, less ? less->noise : 0.0);
  const auto way = [&](std::size_t first, std::size_t end) {
    return WayRound(std::span(repeats).subspan(first, end - first), noise);
  };
  bool is_reversed = way(all - kPlaces, all) < 0;
  for (std::size_t first = kPart; first + kPart <= all && !is_reversed; ++first)
    is_reversed = way(0, first) * way(first, all) < 0;
  if (!is_reversed) return;
  throw DeviceFault(
      FaultKind::kChanged, "instruments",
      fmt::format(
          "show {} at places of this pass the other way round than in the pass before: was a wire "
          "exchanged or its sign, in this pass or that one? Measure mounting {} again, in another run",
          less ? a.column.name + " less " + less->column.name : a.column.name, reading.setup));
}

void Closing::Took(const Reading& reading) {
  const auto is_other = [&](const Reading& r) {
    return r.setup != reading.setup || r.phase != reading.phase || r.reading >= reading.reading;
  };
  std::erase_if(taken_, is_other);
  taken_.push_back(reading);
}

std::size_t Closing::CountOf(int pass) const {
  return static_cast<std::size_t>(std::ranges::count(taken_, pass, &Reading::pass));
}

/// Passes of one direction take as long to every place: between them a drift could not be told from a jump.
const Reading* Closing::Asks() const {
  constexpr double kSamePlace_rad = 1e-3;  // a table that has turned on for a turn stands elsewhere
  const Reading& last = taken_.back();
  if (last.phase == Phase::kCalibration) return nullptr;
  const auto own = std::ranges::find(taken_, last.pass, &Reading::pass);
  auto turned = own;
  while (turned != taken_.begin() && std::prev(turned)->direction == -last.direction) --turned;
  const auto begun = std::find_if(turned, own, [&](const Reading& r) {
    return r.position == last.position && !(std::abs(r.target_rad - last.target_rad) > kSamePlace_rad) &&
           CountOf(r.pass) == CountOf(last.pass);
  });
  return begun == own ? nullptr : &*begun;
}

void Closing::Require(const Reading& again) const {
  constexpr double kTimesScatter = 8.0;
  const Reading& then = *Asks();
  for (const ClaimedColumn& claim : claims_) {
    const auto left = [&](const Reading& r) { return Left(claim, r); };
    const double off = std::abs(left(again) - left(then));
    const double scatter = ScatterBefore(RepeatsOf(left, taken_.back(), taken_));
    if (!(claim.noise > 0.0) || !(off > std::max(AllowedAtPlace(claim), kTimesScatter * scatter))) continue;
    throw DeviceFault(
        FaultKind::kChanged, "instruments",
        fmt::format("showed {} = {} at reading {} and show {} at its place, come to from the same side, behind the "
                    "passes: a zero, a mirror or the mounting jumped, or it had not come to rest; measure mounting "
                    "{} again, in another run",
                    claim.column.name, claim.column.print(then), then.reading, claim.column.print(again),
                    then.setup));
  }
}

}  // namespace twinbench::procedure
