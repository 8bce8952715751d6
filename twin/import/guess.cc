#include "twin/import/guess.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numeric>
#include <set>
#include <string_view>

#include "twin/core/errors.h"
#include "twin/core/lag.h"
#include "twin/import/angle_and_error.h"
#include "twin/import/axes.h"
#include "twin/import/choices.h"
#include "twin/import/column_words.h"
#include "twin/import/common.h"
#include "twin/import/companions.h"
#include "twin/import/counts.h"
#include "twin/import/join.h"
#include "twin/import/sought.h"
#include "twin/import/unit_names.h"

namespace twinbench::imports {
namespace {

/// Numbers in a list: whole, without a unit, fewer than rows. "Position [deg]" is where a device says that it stands.
bool IsLabel(const Column& column) {
  const double rows = static_cast<double>(column.value.size());
  return column.unit.empty() && std::ranges::all_of(column.value, [rows](double x) {
    return std::isnan(x) || (x == std::round(x) && std::abs(x) < rows);
  });
}

bool IsLabelOf(const std::string& target, const Choice& choice) {
  if (!IsLabel(*choice.column)) return false;
  if (target == "setup") return IsCalledSetup(choice.name);
  if (target != "direction") return SmallLetters(choice.name) == target;
  return IsCalledDirection(choice.name) && StaysWithin(*choice.column, 1.0);
}

/// "position" is where the device stands in a file in which nothing else is: then it is no number of a place.
bool DeviceIsElsewhere(const std::vector<Choice>& columns, const std::vector<std::string>& compared, const Map& map) {
  if (compared.size() < 2 || IsGiven(map, compared[1])) return true;
  std::size_t others = 0;
  for (const Choice& choice : columns) {
    if (SmallLetters(choice.name) == "position" || !Changes(choice)) continue;
    if (Clearness(choice.name, Speaks::kDevice) > 0 || UnitFor(*choice.column, compared[1]) != "") return true;
    ++others;
  }
  return others == compared.size();
}

/// Columns that are called as the bench calls them, in any unit.
void TakeNamesakes(const std::vector<Choice>& columns, const BenchFormat& bench, const std::vector<std::string>& compared,
                   Map& map, std::vector<std::string>& remarks) {
  for (const ReadingColumn& target : bench.columns) {
    const bool common =
        target.name == "setup" || target.name == "pass" || target.name == "direction" || target.name == "position";
    if (IsGiven(map, target.name) || (!target.number && !common)) continue;
    if (target.name == "position" && !DeviceIsElsewhere(columns, compared, map)) continue;
    const auto found = std::ranges::find_if(columns, [&](const Choice& c) {
      if (common) return IsLabelOf(target.name, c);
      return c.name == target.name || SmallLetters(c.name) == BaseOf(target.name) ||
             BaseOf(c.name) == BaseOf(target.name);
    });
    if (found == columns.end()) continue;
    if (std::ranges::find(compared, target.name) == compared.end() && UnitFor(*found->column, target.name).empty() &&
        !IsNoUnit(found->column->unit)) {
      remarks.push_back(fmt::format("\"{}\" is left out: \"{}\" is no unit that {} can have", found->name, found->column->unit, target.name));
      continue;
    }
    Put(target.name, *found, "", map, remarks);
  }
}

/// Whatever it is called: degrees Celsius are nothing else. Of several the one that is read first.
void TakeTemperature(const std::vector<Choice>& columns, const BenchFormat& bench, Map& map, std::vector<std::string>& remarks) {
  const auto is_temperature = [](const std::optional<NamedUnit>& unit) {
    return unit && unit->dimension == Dimension::kTemperature;
  };
  const auto target = std::ranges::find_if(bench.columns, [&](const ReadingColumn& c) {
    return c.number && is_temperature(UnitAtEnd(c.name));
  });
  if (target == bench.columns.end() || IsGiven(map, target->name)) return;
  std::vector<const Choice*> found;
  for (const Choice& c : columns) {
    const auto unit = UnitNamed(c.column->unit);
    if (unit ? is_temperature(unit) : IsNoUnit(c.column->unit) && IsCalledTemperature(c.name)) found.push_back(&c);
  }
  if (found.empty()) return;
  Put(target->name, *found.front(), found.size() > 1 ? fmt::format("the first of {} such", found.size()) : "as a temperature", map, remarks);
}

/// The "order" in which readings were taken orders nothing.
bool IsOrderOfRows(const Choice& choice) {
  return BareName(choice.name) == "order" && IsCounter(*choice.column);
}

const Choice* Clearest(const std::vector<Choice>& columns, Speaks of, const std::set<std::string>& taken) {
  const Choice* best = nullptr;
  int clearness = 0;
  for (const Choice& column : columns) {
    const int clear = taken.contains(column.name) || IsOrderOfRows(column) ? 0 : Clearness(column.name, of);
    const int own = clear > 0 ? 2 * clear + (IsCalledPlace(column.name) ? 1 : 0) : 0;
    if (own > clearness) {
      clearness = own;
      best = &column;
    }
  }
  return best;
}


/// "approach" or "side" is the direction where the bench's own name for it is in no file.
void TakeDirection(const std::vector<Choice>& columns, Map& map, std::vector<std::string>& remarks) {
  if (IsGiven(map, "direction")) return;
  const auto found = std::ranges::find_if(columns, [](const Choice& c) { return IsLabelOf("direction", c); });
  if (found != columns.end()) Put("direction", *found, "by its name", map, remarks);
}

/// How many letters two names begin and end alike: "target pos (3)" and "pos (3)" are of one axis, "X_RSol" and "X_RIst" too.
std::ptrdiff_t Alike(const std::string& a, const std::string& b) {
  const auto begin = std::ranges::mismatch(a, b).in1 - a.begin();
  const auto [end, other] = std::mismatch(a.rbegin(), a.rend(), b.rbegin(), b.rend());
  return begin + (end - a.rbegin());
}

/// Of several axes that are sent to one place each, a device for each, the first whose device moves at all; null: of no such.
const Choice* FirstOfStanding(const std::vector<Choice>& columns, const std::vector<Choice>& moving, const std::set<std::string>& taken) {
  std::vector<const Choice*> sent;
  for (const Choice& c : columns) {
    if (!taken.contains(c.name) && Clearness(c.name, Speaks::kReference) > 0) sent.push_back(&c);
  }
  const auto is_device = [](const Choice& c) { return Clearness(c.name, Speaks::kDevice) > 0; };
  if (sent.size() < moving.size() || !std::ranges::all_of(moving, is_device)) return nullptr;
  const auto alike_most = [&moving](const Choice* c) {
    std::ptrdiff_t most = 0;
    for (const Choice& device : moving) most = std::max(most, Alike(c->name, device.name));
    return most;
  };
  return *std::ranges::max_element(sent, {}, alike_most);
}

/// A reference may stand still where one place is approached from both sides, or where each of several axes is sent to one: then its
/// name has to say what it is.
void TakeReferenceByName(const std::vector<Choice>& columns, const std::vector<std::string>& compared, Map& map,
                         std::vector<std::string>& remarks) {
  if (IsGiven(map, compared[0])) return;
  const std::set<std::string> taken = Taken(map);
  std::vector<Choice> moving, standing;
  std::ranges::copy_if(columns, std::back_inserter(standing), [](const Choice& c) { return !IsOtherQuantity(*c.column); });
  std::ranges::copy_if(standing, std::back_inserter(moving), [&taken](const Choice& c) {
    return Changes(c) && !taken.contains(c.name) && !IsCalledError(c.name);
  });
  const Choice* found = Clearest(moving, Speaks::kReference, taken);
  const bool may_stand = moving.size() < compared.size() || IsGiven(map, "direction");
  if (!found && may_stand) found = Clearest(standing, Speaks::kReference, taken);
  if (!found && !moving.empty()) found = FirstOfStanding(standing, moving, taken);
  if (found) Put(compared[0], *found, "by its name", map, remarks);
}

/// All whose names speak of the device as clearly as `best` does.
std::vector<const Choice*> AsClear(const std::vector<Choice>& columns, const Choice& best, const std::set<std::string>& taken) {
  std::vector<const Choice*> tied;
  for (const Choice& c : columns) {
    if (!taken.contains(c.name) && Clearness(c.name, Speaks::kDevice) == Clearness(best.name, Speaks::kDevice)) tied.push_back(&c);
  }
  return tied;
}

/// Of several devices the one that is called most as the reference is; none where there is no reference to go by.
void PutDevice(const std::string& target, const std::vector<const Choice*>& tied, const std::string& reference, Map& map,
               std::vector<std::string>& remarks) {
  if (tied.size() > 1 && reference.empty()) return;
  const auto best = std::ranges::max_element(tied, {}, [&reference](const Choice* c) { return Alike(c->name, reference); });
  Put(target, **best, tied.size() > 1 ? fmt::format("by its name, one of {} such", tied.size()) : "by its name", map, remarks);
}

/// Beside several that are called devices the only one that is not; null: of none, or of several.
const Choice* OnlyNoDevice(const std::vector<Choice>& columns, const std::set<std::string>& taken) {
  const Choice* only = nullptr;
  std::size_t devices = 0;
  for (const Choice& c : columns) {
    if (taken.contains(c.name) || IsCounter(*c.column)) continue;
    if (Clearness(c.name, Speaks::kDevice) > 0) {
      ++devices;
    } else if (only) {
      return nullptr;
    } else {
      only = &c;
    }
  }
  return devices > 1 ? only : nullptr;
}

/// "real" is where a device is beside a command, and the truth beside what is called neither.
const Choice* TheReal(const std::vector<Choice>& columns, const std::set<std::string>& taken) {
  const auto is_open = [&taken](const Choice& c) { return !taken.contains(c.name); };
  const auto real = std::ranges::find_if(columns, [&](const Choice& c) { return is_open(c) && ClearnessBy(c.name, {"real"}) > 0; });
  if (real == columns.end()) return nullptr;
  const bool is_alone = std::ranges::none_of(columns, [&](const Choice& c) { return is_open(c) && &c != &*real && Clearness(c.name, Speaks::kDevice) > 0; });
  return is_alone ? &*real : nullptr;
}

/// A name that speaks of one side goes before what the values say of the order.
void TurnByName(AxisPair& pair) {
  const auto speaks_otherwise = [](const Choice* c, Speaks own, Speaks other) { return Clearness(c->name, own) == 0 && Clearness(c->name, other) > 0; };
  if (speaks_otherwise(pair.reference, Speaks::kReference, Speaks::kDevice) && Clearness(pair.shown->name, Speaks::kDevice) == 0)
    std::swap(pair.reference, pair.shown);
}

std::vector<AxisPair> CompanionsAmong(const std::vector<Choice>& columns) {
  const auto is_mostly_empty = [](const Choice& c) { return 2 * std::ranges::count_if(c.column->value, [](double x) { return std::isnan(x); }) > std::ssize(c.column->value); };
  std::vector<const Choice*> open;
  for (const Choice& c : columns)
    if (!IsCounter(*c.column) && !is_mostly_empty(c)) open.push_back(&c);
  std::vector<AxisPair> pairs = CompanionsIn(open);
  std::ranges::for_each(pairs, TurnByName);
  return pairs;
}

/// Of columns whose names do not say enough those that go together.
/// @return false if there are none, or not with the one that is given.
bool TakeCompanions(const std::vector<Choice>& columns, const std::vector<std::string>& compared, Map& map, std::vector<std::string>& remarks) {
  if (compared.size() != 2) return false;
  std::vector<AxisPair> pairs = CompanionsAmong(columns);
  std::erase_if(pairs, std::not_fn(MayBeOneAxis));
  for (std::size_t k = 0; k < 2; ++k) {
    if (!IsGiven(map, compared[k])) continue;
    const auto is_given = [&](const Choice* c) { return c->name == GivenExpression(map, compared[k]); };
    const auto with_given = std::ranges::find_if(pairs, [&](const AxisPair& p) { return is_given(p.reference) || is_given(p.shown); });
    if (with_given == pairs.end()) return false;
    Put(compared[1 - k], is_given(with_given->reference) ? *with_given->shown : *with_given->reference, "which goes with it", map, remarks);
    return true;
  }
  if (pairs.empty()) return false;
  TakeOneOf(pairs, compared, map, remarks);
  return true;
}

/// Two that go together and are called so differently that only the user knows whether they are one axis.
std::string WhatGoesTogether(const std::vector<Choice>& columns) {
  const std::vector<AxisPair> pairs = CompanionsAmong(columns);
  if (pairs.empty()) return "";
  const std::string &a = pairs[0].reference->name, &b = pairs[0].shown->name;
  return fmt::format("; \"{}\" and \"{}\" go together: --column 'reference_deg=[{}]' --column 'measured_deg=[{}]' if they are one axis", a, b, a, b);
}

/// Three and more of which no name says which is the reference.
bool AreManyWithoutReference(const std::vector<Choice>& columns, const std::vector<std::string>& compared, const Map& map) {
  const auto is_reference = [](const Choice& c) { return Clearness(c.name, Speaks::kReference) > 0; };
  return compared.size() == 2 && !IsGiven(map, compared[0]) && !IsGiven(map, compared[1]) && columns.size() > 2 && std::ranges::none_of(columns, is_reference);
}

/// Nearly all of a size: places that somebody chose.
bool GoesByEvenSteps(const Column& column) {
  constexpr double kEven = 0.01;
  constexpr std::size_t kFewest = 8;
  std::vector<double> sizes = StepsOf(column.value);
  for (double& step : sizes) step = std::abs(step);
  if (sizes.size() < kFewest) return false;
  const double usual = MedianOf(sizes);
  return usual > 0.0 && 10 * std::ranges::count_if(sizes, [&](double size) { return std::abs(size - usual) < kEven * usual; }) > 9 * std::ssize(sizes);
}

/// "angle" beside "code" or "pot": what is called a place and nothing else, and goes by even steps where the other does not, is where
/// the other was sent.
bool TakeEvenPlaces(const std::vector<Choice>& columns, const std::vector<std::string>& compared, Map& map, std::vector<std::string>& remarks) {
  if (columns.size() != 2 || compared.size() != 2 || IsGiven(map, compared[0]) || IsGiven(map, compared[1])) return false;
  for (const auto& [place, other] : {std::pair(&columns[0], &columns[1]), {&columns[1], &columns[0]}}) {
    if (!SaysOnlyPlace(place->name) || Clearness(other->name, Speaks::kReference) > 0 || !GoesByEvenSteps(*place->column) || GoesByEvenSteps(*other->column)) continue;
    Put(compared[0], *place, "which goes by even steps", map, remarks);
    Put(compared[1], *other, "the other one", map, remarks);
    return true;
  }
  return false;
}

void TakeByName(const std::vector<Choice>& columns, const std::vector<std::string>& compared, Map& map,
                std::vector<std::string>& remarks) {
  if (TakeEvenPlaces(columns, compared, map, remarks)) return;
  for (std::size_t k = 0; k < compared.size(); ++k) {
    if (IsGiven(map, compared[k])) continue;
    const std::set<std::string> taken = Taken(map);
    const Choice* found = Clearest(columns, k == 0 ? Speaks::kReference : Speaks::kDevice, taken);
    if (!found && k == 0) found = OnlyNoDevice(columns, taken);
    if (!found && k == 0) found = TheReal(columns, taken);
    if (!found) continue;
    if (k == 0) {
      Put(compared[k], *found, "by its name", map, remarks);
    } else {
      PutDevice(compared[k], AsClear(columns, *found, taken), GivenExpression(map, compared[0]), map, remarks);
    }
  }
}

/// "--column 'reference_rad=[Input Rate] * 0.10472'": a rate in the unit that its angle would have, a second long.
std::string AsFormula(const std::string& target, const Choice& rate) {
  const auto unit = UnitNamed(rate.column->unit);
  const char* key = unit && unit->dimension == Dimension::kSpeed ? "m" : "rad";
  return fmt::format(" --column '{}_{}=[{}]{}'", BaseOf(target), key, rate.name, unit ? fmt::format(" * {:.6g}", unit->to_SI) : " * FACTOR");
}

/// Where hardly anything but rates is there: they are no angles, and no train turns by them.
void RequireMoreThanRates(const std::vector<Choice>& columns, const std::vector<Recording>& recordings, const std::vector<std::string>& compared, const Map& map) {
  const auto missing = std::ranges::count_if(compared, [&map](const auto& c) { return !IsGiven(map, c); });
  std::vector<const Choice*> rates;
  std::ptrdiff_t places = 0;
  for (const Choice& c : columns) {
    if (IsRate(*c.column)) rates.push_back(&c);
    places += !IsOtherQuantity(*c.column) && !Taken(map).contains(c.name) ? 1 : 0;
  }
  if (rates.empty() || places >= missing) return;
  std::string names, formulas;
  for (const Choice* rate : rates) {
    const std::string& unit = rate->column->unit;
    names += fmt::format("{}\"{}\"{}", names.empty() ? "" : ", ", rate->name, unit.empty() ? "" : " [" + unit + "]");
  }
  for (std::size_t k = 0; k < std::min(rates.size(), compared.size()); ++k) formulas += AsFormula(compared[k], *rates[k]);
  throw InputError(recordings[0].file, fmt::format("{} {}: what is compared are angles or positions", names, rates.size() > 1 ? "are rates" : "is a rate"),
                   fmt::format("columns of angles, such as what a rate adds up to; or, to compare rates, a formula to one unit for each:{}", formulas));
}

/// "column 13" behind columns that have names, or the date of the recording in the line of the names.
bool IsNameless(const Choice& choice) {
  const std::size_t digit = choice.name.find_first_of("0123456789");
  if (digit == std::string::npos) return false;
  if (choice.name.substr(0, digit) == "column ") return true;
  int first = 0, second = 0, third = 0;
  char mark = '\0', again = '\0';
  const int read = std::sscanf(choice.name.c_str() + digit, "%4d%c%2d%c%4d", &first, &mark, &second, &again, &third);
  constexpr int kLastDay = 31;
  return read == 5 && mark == again && std::string_view("-/.").find(mark) != std::string_view::npos && std::max(first, third) > kLastDay;
}

/// A length beside an angle, where an angle is there.
bool IsOfAnotherDimension(const Choice& choice, const Map& map) {
  const auto own = UnitNamed(choice.column->unit);
  return own && std::ranges::any_of(map.columns, [&own](const MappedColumn& c) {
           const auto unit = UnitNamed(c.unit), of_bench = UnitAtEnd(c.column);
           return unit && of_bench && of_bench->dimension == Dimension::kAngle && unit->dimension != own->dimension;
         });
}

/// Of a quantity of another kind beside the only place, the pulses of a servo, say: the place that a straight line makes of it.
std::string PlaceByLine(const std::vector<Recording>& recordings, const std::string& target, const Choice& place) {
  const auto mean = [](const std::vector<double>& x) { return std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size()); };
  for (const Choice& c : NumberColumns(recordings)) {
    if (c.name == place.name || !Changes(c) || c.track != place.track || IsCounter(*c.column)) continue;
    const StraightLine line = LineThrough(c.column->value, place.column->value);
    if (std::abs(line.correlation) < 0.9) continue;
    const double offset = mean(place.column->value) - line.slope * mean(c.column->value);
    return fmt::format("; --column '{}=[{}] * {:.5g} + {:.5g}' is the straight line from it to \"{}\", which shows how straight that goes", target, c.name, line.slope, offset, place.name);
  }
  return "";
}

/// The line to type, with columns that there are: which of them it is only the user knows.
std::string ExampleOf(const std::vector<Choice>& left, const std::vector<Recording>& recordings, const std::vector<std::string>& compared, const Map& map) {
  std::string example;
  auto next = left.begin();
  for (const std::string& target : compared) {
    if (IsGiven(map, target)) continue;
    const std::string unit = next == left.end() ? "" : UnitFor(*next->column, target);
    const std::string name = next == left.end() ? "a column" : FullName(next->name, *next->recording, recordings);
    example += fmt::format(" --column '{}=[{}]'", unit.empty() ? target : BaseOf(target) + "_" + unit, name);
    if (next != left.end()) ++next;
  }
  return fmt::format("the columns that are meant, as in{}, or under [columns] of a map", example);
}

/// An error by the time alone has its reference in the clock: the sky that a mount follows.
std::string ErrorByTime(const std::vector<Choice>& columns, const std::vector<std::string>& compared) {
  if (columns.size() != 1 || compared.size() != 2 || !IsCalledError(columns[0].name) || !columns[0].track->HasClock()) return "";
  constexpr double kSky_arcsec_s = 15.041;
  const auto unit = UnitNamed(columns[0].column->unit);
  const bool is_known = unit && unit->dimension == Dimension::kAngle;
  const std::string suffix = is_known ? columns[0].column->unit : "arcsec";
  const double factor = kSky_arcsec_s * units::arcsec / (is_known ? unit->to_SI : units::arcsec);
  return fmt::format("; of a mount that follows the sky, an error by the time is --column '{}_{}=time_s*{:.6g}' --column '{}_{}=time_s*{:.6g}+[{}]'", BaseOf(compared[0]), suffix,
                     factor, BaseOf(compared[1]), suffix, factor, columns[0].name);
}

/// A target that is one place in all rows is why no reference is found.
std::string StandingTarget(const std::vector<Recording>& recordings) {
  for (const Choice& c : NumberColumns(recordings)) {
    if (!Changes(c) && IsCalledCommand(c.name)) return fmt::format("; \"{}\" is none, which is {:g} in all rows and never moves", c.name, c.column->value.front());
  }
  return "";
}

void TakeWhatIsLeft(const std::vector<Choice>& columns, const std::vector<Recording>& recordings,
                    const std::vector<std::string>& compared, Map& map, std::vector<std::string>& remarks) {
  for (std::size_t k = 0; k < compared.size(); ++k) {
    if (IsGiven(map, compared[k])) continue;
    const std::set<std::string> taken = Taken(map);
    std::vector<Choice> left;
    std::ranges::copy_if(columns, std::back_inserter(left),
                         [&taken](const Choice& c) { return !taken.contains(c.name); });
    const std::vector<Choice> open = left;
    const std::size_t missing = static_cast<std::size_t>(
        std::ranges::count_if(compared, [&map](const auto& c) { return !IsGiven(map, c); }));
    if (left.size() > missing) std::erase_if(left, [](const Choice& c) { return IsCounter(*c.column); });
    const auto drop_while_others_fit = [&](auto&& is_none) {
      if (static_cast<std::size_t>(std::ranges::count_if(left, std::not_fn(is_none))) >= missing) std::erase_if(left, is_none);
    };
    drop_while_others_fit(IsNameless);
    drop_while_others_fit([&map](const Choice& c) { return IsOfAnotherDimension(c, map); });
    if (left.size() == missing) {
      Put(compared[k], left[0], "the first column that is left", map, remarks);
      continue;
    }
    const std::string kinds = ReadyMapsByNames(recordings[0]);
    if (kinds.empty() && TakeCompanions(columns, compared, map, remarks)) return;
    const std::string names = ColumnNames(recordings);
    const std::string there = names.find(',') == std::string::npos ? fmt::format("there is only {}, and nothing beside it", names) : "there are " + names;
    throw InputError(recordings[0].file, fmt::format("which column is {} is not clear; {}{}", compared[k], there, StandingTarget(recordings)),
                     ExampleOf(left.size() > missing ? left : open, recordings, compared, map) + ErrorByTime(columns, compared) +
                         (columns.size() == 1 ? PlaceByLine(recordings, compared[k], columns[0]) : kinds.empty() ? WhatGoesTogether(columns) : "") + kinds);
  }
}

}  // namespace

void FillIn(const std::vector<Recording>& recordings, const BenchFormat& bench,
            const std::vector<std::string>& compared, Map& map, std::vector<std::string>& remarks) {
  std::vector<Choice> columns = NumberColumns(recordings);
  TakeNamesakes(columns, bench, compared, map, remarks);
  TakeTemperature(columns, bench, map, remarks);
  if (compared.empty()) return;
  TakeDirection(columns, map, remarks);
  RequireMoreThanRates(columns, recordings, compared, map);
  TakeReferenceByName(columns, compared, map, remarks);
  std::erase_if(columns, [](const Choice& choice) { return !Changes(choice) || IsOtherQuantity(*choice.column); });
  if (TakeAngleAndError(columns, compared, map, remarks)) return;
  if (columns.size() > compared.size()) std::erase_if(columns, [](const Choice& c) { return IsCalledError(c.name); });
  const std::string reference = GivenExpression(map, compared[0]);
  std::erase_if(columns, [&reference](const Choice& c) { return AreOfTwoAxes(c.name, reference); });
  if (!AreManyWithoutReference(columns, compared, map) || !TakeCompanions(columns, compared, map, remarks)) TakeByName(columns, compared, map, remarks);
  TakeWhatIsLeft(columns, recordings, compared, map, remarks);
  TakeCountsBesideAngle(compared, recordings, map, remarks);
  TakeBothForCounts(compared, recordings, map, remarks);
  RequireCountsPerTurn(recordings, map);
}

void TakeReadyMapOfList(const std::vector<Recording>& recordings, Map& map, std::vector<std::string>& remarks) {
  constexpr double kLargestError_rad = 0.5;
  if (recordings.size() != 1 || recordings[0].tracks.size() != 1 || !map.name.empty() || !map.columns.empty()) return;
  const std::vector<Column>& columns = recordings[0].tracks[0].columns;
  if (columns.size() != 1 || columns[0].name != "entry") return;
  const bool errors = AreErrorsOf16Bit(columns[0].value) || StaysWithin(columns[0], kLargestError_rad);
  const Map ready = LoadMap(errors ? "correction_table" : "lookup_table");
  map.name = ready.name;
  map.bench = ready.bench;
  map.columns = ready.columns;
  map.course.kind = ready.course.kind;
  remarks.push_back(fmt::format("a list of {}: taken as --map {}", errors ? "small errors" : "angles that go round once", ready.name));
}

const BenchFormat& BenchFor(const std::vector<Recording>& recordings, const Map& map) {
  if (!map.bench.empty()) return FormatOf(map.bench);
  // Where an axis was sent to is called alike everywhere: what it showed says whose readings they are.
  const BenchFormat* by_name = FormatByColumns([&](const ReadingColumn& column) {
    if (column.role != ColumnRole::kShown) return false;
    if (IsGiven(map, column.name)) return true;
    return std::ranges::any_of(recordings, [&column](const Recording& recording) {
      return std::ranges::any_of(recording.tracks, [&column](const Track& track) {
        return std::ranges::any_of(track.columns, [&column](const Column& c) { return c.name == column.name; });
      });
    });
  });
  if (by_name) return *by_name;
  const auto compares =
      std::ranges::find_if(BenchFormats(), [](const BenchFormat* f) { return f->compared.has_value(); });
  if (compares != BenchFormats().end()) return **compares;
  throw InputError(recordings[0].file, "the columns are those of no known bench", "bench = ... in a map");
}

}  // namespace twinbench::imports
