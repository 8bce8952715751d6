#include "twin/import/column_functions.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "twin/core/errors.h"
#include "twin/core/robust_scale.h"
#include "twin/core/units.h"
#include "twin/import/common.h"
#include "twin/import/formula_functions.h"

namespace twinbench::imports {
namespace {

constexpr double kTurn_deg = 360.0;

/// A table that goes round once leaves out its last step: n entries span (n - 1) / n of a turn.
std::vector<double> Turns(std::vector<double> x, const std::string& where) {
  const auto [low, high] = std::ranges::minmax(x);
  const double turn =
      (high - low) * static_cast<double>(x.size()) / std::max(1.0, static_cast<double>(x.size()) - 1.0);
  std::vector<double> known = {1.0, 2.0 * units::kPi, 360.0, 400.0, 3600.0, 36000.0, 360000.0, 1296000.0};
  for (int bits = 8; bits <= 32; ++bits) known.push_back(std::ldexp(1.0, bits));
  for (const double steps : {200.0, 1600.0, 3200.0, 6400.0, 12800.0, 25600.0, 51200.0, 20000.0})
    known.push_back(steps);
  const double nearest =
      *std::ranges::min_element(known, {}, [turn](double k) { return std::abs(std::log(turn / k)); });
  if (!(std::abs(turn / nearest - 1.0) < 0.02))
    throw InputError(
        where,
        fmt::format("the entries go from {:.6g} to {:.6g}, which is one turn of no unit that is known", low,
                    high),
        "a factor instead of turns(...)");
  for (double& value : x) value /= nearest;
  return x;
}

/// Errors of an angle as firmwares print them: rad, or 16 bit about their middle. No sensor errs by half a turn.
std::vector<double> Correction(std::vector<double> x, const std::string& where) {
  const bool of_16_bit = AreErrorsOf16Bit(x);
  const auto [low, high] = std::ranges::minmax(x);
  if (!of_16_bit && !(std::max(high, -low) < units::kPi))
    throw InputError(where, fmt::format("the entries go from {:.6g} to {:.6g}: they are no errors in rad", low, high),
                     "a map with a factor instead of correction(entry), as in (entry - 32768) / 65536 of 16 bit about their middle, or "
                     "--map lookup_table for a table of angles");
  for (double& value : x) value = of_16_bit ? (value - 32768.0) / 65536.0 : value / units::turn;
  return x;
}

std::vector<double> Parts(std::vector<double> x, const std::string&) {
  std::vector<double> part(x.size(), 0.0);
  for (std::size_t i = 1; i < x.size(); ++i) part[i] = part[i - 1] + (x[i] != x[i - 1] ? 1.0 : 0.0);
  return part;
}

/// The first row has that of the second.
std::vector<double> Step(std::vector<double> x, const std::string&) {
  std::vector<double> step(x.size(), 0.0);
  for (std::size_t i = 1; i < x.size(); ++i) step[i] = x[i] - x[i - 1];
  if (x.size() > 1) step[0] = step[1];
  return step;
}

std::vector<double> Middle(std::vector<double> x, const std::string&) {
  const auto [low, high] = std::ranges::minmax(x);
  return {0.5 * (low + high)};
}

std::vector<double> Span(std::vector<double> x, const std::string&) {
  const auto [low, high] = std::ranges::minmax(x);
  return {high - low};
}

/// Of the steps before and behind a row that one counts which is more like the others: the other one may be a way back.
/// Where it hardly moves, noise goes to and fro: a way of one sense that is no longer than that belongs to the one before it.
void LeaveNoiseOut(const std::vector<double>& steps, std::vector<double>& sense) {
  constexpr double kOfNoise = 8.0;
  std::vector<double> bends;
  for (std::size_t i = 1; i < steps.size(); ++i) bends.push_back(std::abs(steps[i] - steps[i - 1]));
  if (bends.empty()) return;
  const double noise = 1.48 / std::sqrt(6.0) * MedianOf(std::move(bends));  // of a second difference
  double held = 0.0;  // 0: none before
  for (std::size_t begin = 0, end = 0; begin < sense.size(); begin = end) {
    double way = 0.0;
    for (end = begin; end < sense.size() && sense[end] == sense[begin]; ++end) way += end > 0 ? steps[end - 1] : 0.0;
    if (held != 0.0 && std::abs(way) < kOfNoise * noise)
      std::fill(sense.begin() + static_cast<std::ptrdiff_t>(begin), sense.begin() + static_cast<std::ptrdiff_t>(end), held);
    else
      held = sense[begin];
  }
}

std::vector<double> Sense(std::vector<double> x, const std::string&) {
  std::vector<double> steps, sizes;
  for (std::size_t i = 1; i < x.size(); ++i) {
    steps.push_back(std::remainder(x[i] - x[i - 1], kTurn_deg));
    sizes.push_back(std::abs(steps.back()));
  }
  const double usual = MedianOf(sizes);
  std::vector<double> sense(x.size(), 1.0);
  for (std::size_t i = 0; i < x.size() && !steps.empty(); ++i) {
    const double before = steps[i == 0 ? 0 : i - 1], behind = steps[std::min(i, steps.size() - 1)];
    sense[i] = std::copysign(1.0, std::abs(std::abs(behind) - usual) < std::abs(std::abs(before) - usual) ? behind : before);
  }
  LeaveNoiseOut(steps, sense);
  return sense;
}

std::vector<double> Distinct(std::vector<double> x, const std::string&) {
  constexpr double kSame = 1e-9;
  std::erase_if(x, [](double value) { return !std::isfinite(value); });
  std::ranges::sort(x);
  const auto end = std::unique(x.begin(), x.end(), [](double a, double b) { return b - a < kSame; });
  return {static_cast<double>(end - x.begin())};
}

/// Of angles that stand evenly round a turn, some of which may be missing or come twice; else the number of
/// different ones.
std::vector<double> Seats(std::vector<double> x, const std::string&) {
  constexpr double kSame_deg = 1e-3, kOff = 0.02;  // of a step: what writing angles down may have cost
  std::erase_if(x, [](double value) { return !std::isfinite(value); });
  if (x.empty()) return {0.0};
  const double first = x.front();
  for (double& value : x)
    value = std::fmod(std::fmod(value - first, kTurn_deg) + kTurn_deg + 0.5 * kSame_deg, kTurn_deg);
  std::ranges::sort(x);
  x.erase(std::unique(x.begin(), x.end(), [](double a, double b) { return b - a < kSame_deg; }), x.end());
  const auto different = static_cast<double>(x.size());
  double step_deg = kTurn_deg - x.back() + x.front();
  for (std::size_t i = 1; i < x.size(); ++i) step_deg = std::min(step_deg, x[i] - x[i - 1]);
  const double seats = std::round(kTurn_deg / step_deg);
  const bool are_even = std::ranges::all_of(x, [seats](double value) {
    return std::abs(std::remainder((value - 0.5 * kSame_deg) * seats / kTurn_deg, 1.0)) < kOff;
  });
  return {are_even ? seats : different};
}

/// From 0 deg up to a turn.
std::vector<double> WithinTurn(std::vector<double> x, const std::string&) {
  for (double& angle_deg : x) angle_deg -= kTurn_deg * std::floor(angle_deg / kTurn_deg);
  return x;
}

/// Angles numbered as they lie round the circle, wherever they come again.
std::vector<double> Places(std::vector<double> x, const std::string&) {
  constexpr double kSame_deg = 1e-6;
  const auto at = [](double angle_deg) {
    if (!std::isfinite(angle_deg)) return 0L;
    return std::lround((angle_deg - kTurn_deg * std::floor(angle_deg / kTurn_deg + kSame_deg)) / kSame_deg);
  };
  std::map<long, double> number;
  for (const double angle_deg : x) number[at(angle_deg)] = 0.0;
  double next = 0.0;
  for (auto& [where, own] : number) own = next++;
  for (double& angle_deg : x) angle_deg = number[at(angle_deg)];
  return x;
}

/// Of values of one group less their mean, pooled; a single value that is far off does not widen it, unless more than half
/// are alike to the last digit. 0 where no group has two.
std::vector<double> Scatter(const std::vector<double>& x, const std::vector<double>& group, const std::string&) {
  std::map<double, std::vector<double>> groups;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (std::isfinite(x[i]) && std::isfinite(group[i])) groups[group[i]].push_back(x[i]);
  }
  std::vector<double> left;
  double freedom = 0.0, squares = 0.0;
  for (const auto& [number, values] : groups) {
    if (values.size() < 2) continue;
    const double count = static_cast<double>(values.size());
    double mean = 0.0;
    for (const double value : values) mean += value / count;
    for (const double value : values) {
      left.push_back(value - mean);
      squares += (value - mean) * (value - mean);
    }
    freedom += count - 1.0;
  }
  if (left.empty()) return {0.0};
  const double robust = RobustDeviation(left) * std::sqrt(static_cast<double>(left.size()) / freedom);
  return {robust > 0.0 ? robust : std::sqrt(squares / freedom)};
}

template <class Function>
struct NamedFunction {
  std::string_view name;
  Function function;
};

template <class Function, std::size_t kCount>
Function FindIn(const std::array<NamedFunction<Function>, kCount>& table, std::string_view name) {
  const auto found = std::ranges::find(table, name, &NamedFunction<Function>::name);
  return found == table.end() ? nullptr : found->function;
}

}  // namespace

OfColumn ColumnFunction(std::string_view name) {
  static constexpr auto kFunctions =
      std::to_array<NamedFunction<OfColumn>>({{"turns", Turns},
                                              {"correction", Correction},
                                              {"parts", Parts},
                                              {"step", Step},
                                              {"middle", Middle},
                                              {"span", Span},
                                              {"sense", Sense},
                                              {"whole", Whole},
                                              {"levels", Levels},
                                              {"unwrapped", Unwrapped},
                                              {"distinct", Distinct},
                                              {"seats", Seats},
                                              {"places", Places},
                                              {"within_turn", WithinTurn}});
  return FindIn(kFunctions, name);
}

OfColumns ColumnsFunction(std::string_view name) {
  static constexpr auto kFunctions =
      std::to_array<NamedFunction<OfColumns>>({{"ratio", Ratio}, {"whole_turns", WholeTurns}, {"beside", Beside}, {"stated_ratio", StatedRatio}, {"unsteady", Unsteady}, {"by_index", ByIndex}, {"circle_middle", CircleMiddle}, {"circle_radius", CircleRadius}, {"scatter", Scatter}});
  return FindIn(kFunctions, name);
}

}  // namespace twinbench::imports
