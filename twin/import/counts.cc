#include "twin/import/counts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>

#include "twin/core/errors.h"
#include "twin/core/lag.h"
#include "twin/core/units.h"
#include "twin/import/column_words.h"
#include "twin/import/common.h"
#include "twin/import/follows.h"
#include "twin/import/table.h"
#include "twin/import/unit_names.h"

namespace twinbench::imports {
namespace {

bool SpeaksOf(const std::string& text, const std::vector<const char*>& words) {
  const std::string small = SmallLetters(text);
  return std::ranges::any_of(words, [&small](const char* word) { return small.find(word) != std::string::npos; });
}

bool AreWhole(const Column& column) {
  return std::ranges::all_of(column.value, [](double x) { return std::isnan(x) || x == std::round(x); });
}

/// By the column's own name or unit, "encoder [4096 counts/rev]", by a line that has a word of its own, or by what stands above the rows.
std::optional<double> StatedPerTurn(const Column& column, const Track& track, const std::vector<std::string>& words = {}) {
  Track own;
  AddNumbers(column.name + " " + column.unit, own);
  for (const TextLine& line : track.lines) {
    for (std::string_view rest = line.text; !rest.empty() && own.numbers.empty();) {
      const std::size_t end = std::min(rest.find_first_of(",;"), rest.size());
      if (ClearnessBy(std::string(rest.substr(0, end)), words) > 0) AddNumbers(rest.substr(0, end), own);
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
  }
  for (const Track* said : {static_cast<const Track*>(&own), &track}) {
    for (const auto& [name, number] : said->numbers) {
      if (SaysPerTurn(SmallLetters(name)) && number > 1.0) return number;
    }
  }
  return std::nullopt;
}

/// What the map has as the other angle, in rad; nothing if it is no column of this track as it stands.
std::vector<double> OtherAngle(const std::string& target, const Track& track, const Map& map) {
  for (const MappedColumn& other : map.columns) {
    const auto unit = UnitNamed(other.unit);
    if (other.column == target || !unit || unit->dimension != Dimension::kAngle) continue;
    const auto found = std::ranges::find(track.columns, other.expression, &Column::name);
    if (found == track.columns.end()) continue;
    std::vector<double> angle = found->value;
    for (double& x : angle) x *= unit->to_SI;
    return angle;
  }
  return {};
}

/// How many counts make a turn, and why that is thought.
struct PerTurn {
  double counts = 0.0;
  std::string why;
};

std::optional<PerTurn> PowerOfTwo(const std::vector<double>& reference, const std::vector<double>& counts) {
  constexpr double kSame = 0.02, kClearly = 0.99, kToBeSaid = 1e-3;
  for (int bits = 8; bits <= 32; ++bits) {
    std::vector<double> angle = counts;
    for (double& x : angle) x *= units::turn / std::ldexp(1.0, bits);
    const Following following = FollowingOf(reference, angle);
    const double off = std::abs(following.gain) - 1.0;
    if (std::abs(off) > kSame || !(std::abs(following.correlation) > kClearly)) continue;
    const std::string scale =
        std::abs(off) > kToBeSaid
            ? fmt::format("; {:+.2g} % that it is off are taken for an error of its scale", 100.0 * off)
            : "";
    return PerTurn{std::ldexp(1.0, bits), "the power of two at which it follows" + scale};
  }
  return std::nullopt;
}

/// A motor's encoder in front of a gear.
struct Gear {
  double turns = 0.0, per_motor_turn = 0.0;

  double Counts() const { return turns * per_motor_turn; }
  /// Gears of 10, 20, 100 are built more often than those of 51.
  int Unusual() const { return std::fmod(turns, 10.0) == 0.0 ? 0 : std::fmod(turns, 5.0) == 0.0 ? 1 : 2; }
};

/// A whole number of motor turns, each of usual counts: the most usual of those that come to what is seen.
std::optional<PerTurn> ByGear(const std::vector<double>& reference, const std::vector<double>& counts) {
  constexpr double kLine = 0.9999, kSame = 5e-3, kMostTurns = 200.0;
  constexpr std::array kUsual = {4096.0, 16384.0, 65536.0, 8192.0, 4000.0, 10000.0, 8000.0, 2048.0, 2000.0, 1024.0};
  const StraightLine line = LineThrough(reference, counts);
  if (!(std::abs(line.correlation) > kLine)) return std::nullopt;
  const double found = std::abs(line.slope) * units::turn;
  std::optional<Gear> best;
  for (const double per_motor_turn : kUsual) {
    const Gear gear{std::round(found / per_motor_turn), per_motor_turn};
    if (gear.turns < 2.0 || gear.turns > kMostTurns || std::abs(found / gear.Counts() - 1.0) > kSame) continue;
    if (!best || gear.Unusual() < best->Unusual()) best = gear;
  }
  if (!best) return std::nullopt;
  return PerTurn{best->Counts(),
                 fmt::format("at which it follows: taken as a motor's behind a gear, {:g}:1 of {:g} counts",
                             best->turns, best->per_motor_turn)};
}

std::optional<PerTurn> FoundPerTurn(const Column& column, const std::vector<double>& other) {
  if (other.size() != column.value.size()) return std::nullopt;
  std::vector<double> reference, counts;
  for (std::size_t i = 0; i < other.size(); ++i) {
    if (!std::isfinite(other[i]) || !std::isfinite(column.value[i])) continue;
    reference.push_back(other[i]);
    counts.push_back(column.value[i]);
  }
  if (counts.size() < 3) return std::nullopt;
  const std::optional<PerTurn> power = PowerOfTwo(reference, counts);
  return power || !IsCalledCounts(column) ? power : ByGear(reference, counts);
}

/// The column that was guessed as it stands; null of what somebody said, or of a formula.
const Column* PlainColumn(const MappedColumn& mapped, const std::vector<Recording>& recordings) {
  if (!mapped.where.empty()) return nullptr;
  for (const Recording& recording : recordings) {
    for (const Track& track : recording.tracks) {
      const auto found = std::ranges::find(track.columns, mapped.expression, &Column::name);
      if (found != track.columns.end()) return &*found;
    }
  }
  return nullptr;
}

double BitsFor(double high) {
  return std::ceil(std::log2(high + 1.0));
}

/// What goes round shows nearly all the counts that it has.
bool GoesRound(double high) {
  constexpr double kNearlyAll = 0.98;
  return high > kNearlyAll * std::exp2(BitsFor(high));
}

/// Encoders of an even number of bits are usual; others are known by going round.
double PerTurnUpTo(double high) {
  const double bits = BitsFor(high);
  return std::exp2(GoesRound(high) ? bits : 2.0 * std::ceil(bits / 2.0));
}

/// The counts of a device beside what they should be, a straight line: both go round at one power of two.
bool IsCourseOfCounts(double high, double other_high) {
  return GoesRound(high) && GoesRound(other_high) && BitsFor(high) == BitsFor(other_high);
}

/// Of a step test only the size of its errors depends on how many counts make a turn, not where they repeat.
bool IsStepTestInCounts(const std::string& reference, const std::vector<Recording>& recordings, const Map& map) {
  constexpr std::size_t kFewPlaces = 3;
  const auto mapped = std::ranges::find(map.columns, reference, &MappedColumn::column);
  const Column* column = mapped == map.columns.end() ? nullptr : PlainColumn(*mapped, recordings);
  return column && IsCalledCounts(*column) &&
         std::set<double>(column->value.begin(), column->value.end()).size() <= kFewPlaces;
}

}  // namespace

std::optional<double> CountsPerTurnOf(const Column& column, const Track& track, const std::vector<std::string>& words) {
  constexpr double kMoreThanATurn_deg = 400.0;  // else whole degrees
  const bool is_large = std::ranges::any_of(column.value, [](double x) { return std::abs(x) > kMoreThanATurn_deg; });
  const bool may_be = AreWhole(column) && (IsCalledCounts(column) || (IsNoUnit(column.unit) && is_large));
  return may_be ? StatedPerTurn(column, track, words) : std::nullopt;
}

bool IsCalledCounts(const Column& column) {
  const std::vector<const char*> words = {"count", "cts", "tick", "pulse", "incr", "lsb", "digit", "cpr", "ppr"};
  return SpeaksOf(column.unit, words) || (column.unit.empty() && SpeaksOf(column.name, words));
}

void RequireCountsPerTurn(const std::vector<Recording>& recordings, const Map& map) {
  for (const auto& [target, name, unit, where] : map.columns) {
    const Column* column = UnitAtEnd(target) ? PlainColumn({target, name, unit, where}, recordings) : nullptr;
    if (!column || !IsCalledCounts(*column) || !AreWhole(*column)) continue;
    throw InputError(recordings[0].file, fmt::format("\"{}\" is in counts, and nothing says how many of them make a turn", column->name),
                     fmt::format("a line \"# counts per turn: N\" above the rows, or --column '{}=[{}] * 360 / N' of each column in counts", target, column->name));
  }
}

void TakeBothForCounts(const std::vector<std::string>& compared, const std::vector<Recording>& recordings, Map& map,
                       std::vector<std::string>& remarks) {
  constexpr double kLeast = 1000.0, kMost = 65536.0;
  const bool is_step_test = IsStepTestInCounts(compared[0], recordings, map);
  std::vector<MappedColumn*> both;
  double high = 0.0, lower = kMost;
  std::ptrdiff_t whole = 0;
  for (MappedColumn& mapped : map.columns) {
    if (std::ranges::find(compared, mapped.column) == compared.end()) continue;
    const Column* column = PlainColumn(mapped, recordings);
    if (!column) return;
    whole += AreWhole(*column) ? 1 : 0;
    const auto [least, most] = std::ranges::minmax(column->value);
    const bool may_be_guessed = is_step_test ? IsCalledCounts(*column) : column->unit.empty() && !IsCalledCounts(*column) && most > kLeast;
    if (!may_be_guessed) return;
    if (!(least >= 0.0) || !(most < kMost)) return;
    high = std::max(high, most);
    lower = std::min(lower, most);
    both.push_back(&mapped);
  }
  if (both.size() != 2 || !(whole == 2 || (whole == 1 && IsCourseOfCounts(high, lower)))) return;
  const double per_turn = PerTurnUpTo(high);
  std::erase_if(remarks, [](const std::string& remark) { return remark.find("its unit is not said") != std::string::npos; });
  const char* what = is_step_test ? "nothing says how many counts make a turn" : whole == 2 ? "whole numbers without a unit" : "both go round at one power of two";
  for (MappedColumn* mapped : both) {
    remarks.push_back(fmt::format("{} is taken from \"{}\": {}, taken as {:g} counts per turn (--column '{}=[{}] * 360 / N' says another)",
                                  mapped->column, mapped->expression, what, per_turn, mapped->column, mapped->expression));
    mapped->expression = fmt::format("[{}] * 360 / {:g}", mapped->expression, per_turn);
    mapped->unit = "deg";
  }
}

bool TakeCounts(const std::string& target, const Column& column, const Track& track, Map& map,
                std::vector<std::string>& remarks) {
  const auto wanted = UnitAtEnd(target);
  const bool unit_is_open = column.unit.empty() || IsCalledCounts(column);
  if (!wanted || wanted->dimension != Dimension::kAngle || !unit_is_open || !AreWhole(column)) return false;
  const std::optional<double> stated = IsCalledCounts(column) ? StatedPerTurn(column, track) : std::nullopt;
  const std::optional<PerTurn> per_turn =
      stated ? PerTurn{*stated, "as the file states"} : FoundPerTurn(column, OtherAngle(target, track, map));
  if (!per_turn) return false;
  map.columns.push_back({target, fmt::format("[{}] * 360 / {:.17g}", column.name, per_turn->counts), "deg", ""});
  remarks.push_back(fmt::format("{} is taken from \"{}\", {:.17g} counts per turn, {}", target, column.name,
                                per_turn->counts, per_turn->why));
  return true;
}

void TakeCountsBesideAngle(const std::vector<std::string>& compared, const std::vector<Recording>& recordings,
                           Map& map, std::vector<std::string>& remarks) {
  for (const std::string& target : compared) {
    const auto mapped = std::ranges::find(map.columns, target, &MappedColumn::column);
    if (mapped == map.columns.end() || !mapped->where.empty()) continue;
    const MappedColumn guessed = *mapped;
    for (const Recording& recording : recordings) {
      for (const Track& track : recording.tracks) {
        const auto column = std::ranges::find(track.columns, guessed.expression, &Column::name);
        if (column == track.columns.end() || !IsCalledCounts(*column)) continue;
        std::vector<std::string> said;
        Map with_counts = map;
        std::erase_if(with_counts.columns, [&target](const MappedColumn& c) { return c.column == target; });
        if (!TakeCounts(target, *column, track, with_counts, said)) continue;
        map = std::move(with_counts);
        std::erase_if(remarks, [&target](const std::string& remark) { return remark.starts_with(target); });
        remarks.insert(remarks.end(), said.begin(), said.end());
        return;
      }
    }
  }
}

}  // namespace twinbench::imports
