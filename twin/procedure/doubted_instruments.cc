#include "twin/procedure/doubted_instruments.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/core/device_fault.h"

namespace twinbench::procedure {
namespace {

/// Readings that are all the same: of steps so coarse that noise hides in them, one in many is another.
constexpr int kAgain = 16;
constexpr int kSamplesTheSame = 64, kSamplesTheSameOfNoise = 16;
constexpr double kAgree = 10.0;                    // times the noise of a difference
constexpr double kFollows_rad = 1.0 * units::deg;  // more than the steps of any encoder

bool IsAngle(const ClaimedColumn& claim) {
  return claim.follows && claim.is_angle;
}

/// Of readings of two places, or of one that noise moves: the same to the last digit, where it should be another.
bool IsTheSame(const ClaimedColumn& claim, const Reading& a, const Reading& b) {
  if (ValueOf(claim, a) != ValueOf(claim, b)) return false;
  return claim.noise > 0.0 || (IsAngle(claim) && std::abs(claim.follows(b) - claim.follows(a)) > kFollows_rad);
}

bool IsShown(const ClaimedColumn& claim, const Reading& reading) {
  return (claim.noise > 0.0 || IsAngle(claim)) && std::isfinite(ValueOf(claim, reading));
}

/// All that can be judged.
bool AreTheSame(const std::vector<ClaimedColumn>& claims, const Reading& a, const Reading& b) {
  const auto is_shown = [&](const ClaimedColumn& claim) { return IsShown(claim, b); };
  return std::ranges::any_of(claims, is_shown) && std::ranges::all_of(claims, [&](const ClaimedColumn& claim) {
           return !is_shown(claim) || IsTheSame(claim, a, b);
         });
}

std::string Text(const ClaimedColumn& claim, const Reading& reading) {
  return fmt::format("{} = {}", claim.column.name, claim.column.print(reading));
}

[[noreturn]] void Fail(const std::string& what) {
  throw DeviceFault(FaultKind::kStuck, "instruments", what);
}

}  // namespace

double ValueOf(const ClaimedColumn& claim, const Reading& reading) {
  Reading copy = reading;
  return claim.column.number(copy);
}

double AllowedAtPlace(const ClaimedColumn& claim) {
  constexpr double kTimesNoise = 30.0;  // of a difference of readings between which axes moved and time went by
  return kTimesNoise * std::sqrt(2.0) * claim.noise + claim.repeats;
}

void RequireGoesAlong(const std::vector<ClaimedColumn>& claims, const Reading& reading, const Reading& before) {
  constexpr double kShareOfAngle = 0.5, kShareOfPlace = 0.1, kShareOfRange = 0.01;
  constexpr double kLeastWay_rad = 0.1 * units::deg;
  if (reading.setup != before.setup) return;
  for (const ClaimedColumn& claim : claims) {
    const double least = claim.is_angle ? kLeastWay_rad : kShareOfRange * claim.range;
    if (!claim.follows || !(least > 0.0)) continue;
    const double way = claim.follows(reading) - claim.follows(before);
    const double went = ValueOf(claim, reading) - ValueOf(claim, before);
    const double off = claim.is_angle ? std::remainder(went - way, units::turn) : went - way;
    const double allowed =
        claim.is_angle ? kShareOfAngle * std::abs(std::remainder(way, units::turn)) : kShareOfPlace * std::abs(way);
    if (!(std::abs(off) > std::max(allowed, least))) continue;
    throw DeviceFault(
        FaultKind::kMoved, "instruments",
        fmt::format("went from {} to {}, which is not the way from the place of reading {} to that of {}: does "
                    "anything stand elsewhere than its controller says?",
                    Text(claim, before), claim.column.print(reading), before.reading, reading.reading));
  }
}

void RequireAsBefore(const std::vector<ClaimedColumn>& claims, const Reading& again, const Reading& before) {
  for (const ClaimedColumn& claim : claims) {
    const double was = ValueOf(claim, before), off = std::abs(ValueOf(claim, again) - was);
    if (!(claim.noise > 0.0) || !std::isfinite(was) || off <= AllowedAtPlace(claim)) continue;
    throw DeviceFault(
        FaultKind::kImplausible, "instruments",
        fmt::format(
            "showed {} at reading {} and show {} at its place behind the fault: is a zero, a unit or the mounting "
            "another than before?",
            Text(claim, before), before.reading, claim.column.print(again)));
  }
}

Reading DoubtedInstruments::Read() {
  const Reading first = inner_.Read();
  if (first.status != ReadingStatus::kOk) return first;
  const Reading shown = Alive(first);
  RequireInRange(shown);
  const bool shows_noise =
      std::ranges::any_of(claims_, [](const ClaimedColumn& claim) { return claim.noise > 0.0; });
  last_ = shows_noise ? OfThisPlace(shown) : shown;
  return shown;
}

void DoubtedInstruments::RequireInRange(const Reading& shown) {
  for (const ClaimedColumn& claim : claims_) {
    if (!(claim.range > 0.0) || !(std::abs(ValueOf(claim, shown)) > claim.range)) continue;
    throw DeviceFault(FaultKind::kProtocol, "instruments", Text(claim, shown) + " is out of range");
  }
}

Reading DoubtedInstruments::Alive(const Reading& shown) {
  bool says_nothing = false, says_anything = false;
  for (const ClaimedColumn& claim : claims_) {
    if (!(claim.noise > 0.0) || !IsShown(claim, shown)) continue;
    (ValueOf(claim, shown) == 0.0 ? says_nothing : says_anything) = true;
  }
  if ((says_anything || !says_nothing) && !(last_ && AreTheSame(claims_, *last_, shown))) return shown;
  for (int again = 0; again < kAgain; ++again) {
    const Reading other = inner_.Read();
    if (std::ranges::any_of(claims_, [&](const ClaimedColumn& claim) {
          return IsShown(claim, shown) && ValueOf(claim, other) != ValueOf(claim, shown);
        }))
      return inner_.Read();
  }
  const auto shows =
      std::ranges::find_if(claims_, [&](const ClaimedColumn& claim) { return IsShown(claim, shown); });
  Fail(fmt::format("show {} as before, and in {} readings more: they are dead or stuck", Text(*shows, shown),
                   kAgain));
}

Reading DoubtedInstruments::OfThisPlace(const Reading& shown) {
  const Reading again = inner_.Read();
  for (const ClaimedColumn& claim : claims_) {
    if (!(claim.noise > 0.0) ||
        !(std::abs(ValueOf(claim, again) - ValueOf(claim, shown)) > kAgree * std::sqrt(2.0) * claim.noise))
      continue;
    Fail(fmt::format(
        "show {} and then {} at one place, by more than noise: do they answer late by one, or move still?",
        Text(claim, shown), Text(claim, again)));
  }
  RequireNoise(shown, again);
  return again;
}

/// Of one channel beside others that live. One whose noise hides in its steps shows the same twice anyway.
void DoubtedInstruments::RequireNoise(const Reading& shown, const Reading& again) {
  constexpr int kFewest = 5;
  constexpr double kNearlyAlways = 0.8;
  for (std::size_t k = 0; k < claims_.size(); ++k) {
    const ClaimedColumn& claim = claims_[k];
    if (!(claim.noise > 0.0) || !IsShown(claim, shown)) continue;
    const auto is_another = [&](const Reading& other) { return ValueOf(claim, other) != ValueOf(claim, shown); };
    Twice& twice = twice_[k];
    const bool shows_noise = twice.read >= kFewest && twice.differed >= kNearlyAlways * twice.read;
    bool differs = is_another(again);
    for (int more = 0; shows_noise && !differs && more < kAgain; ++more) differs = is_another(inner_.Read());
    if (shows_noise && !differs)
      Fail(fmt::format("show {} in {} readings of one place, where it showed noise before: it is dead, stuck or at its end",
                       Text(claim, shown), kAgain + 2));
    ++twice.read, twice.differed += is_another(again);
  }
}

void DoubtedInstruments::Arm(int samples, int lines) {
  last_.reset();
  same_.assign(claims_.size(), 0);
  inner_.Arm(samples, lines);
}

LatchedSamples DoubtedInstruments::Latched() {
  LatchedSamples latched = inner_.Latched();
  for (const Reading& sample : latched.samples) {
    if (sample.status != ReadingStatus::kOk) continue;
    RequireInRange(sample);
    RequireMoving(sample);
    last_ = sample;
  }
  return latched;
}

void DoubtedInstruments::RequireMoving(const Reading& sample) {
  for (std::size_t k = 0; last_ && k < claims_.size(); ++k) {
    same_[k] = ValueOf(claims_[k], *last_) == ValueOf(claims_[k], sample) && IsShown(claims_[k], sample)
                   ? same_[k] + 1
                   : 0;
    if (same_[k] >= (claims_[k].noise > 0.0 ? kSamplesTheSameOfNoise : kSamplesTheSame))
      Fail(fmt::format("show {} in {} samples: they are dead or stuck", Text(claims_[k], sample), same_[k]));
  }
}

}  // namespace twinbench::procedure
