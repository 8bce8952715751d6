#include "twin/import/formula_functions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "twin/core/errors.h"
#include "twin/import/common.h"

namespace twinbench::imports {

std::vector<double> Whole(std::vector<double> x, const std::string&) {
  const double middle = MedianOf(std::move(x));
  const double step = std::pow(10.0, std::floor(std::log10(std::abs(middle))) - 2.0);
  return {middle == 0.0 ? 0.0 : step * std::round(middle / step)};
}

std::vector<double> Levels(std::vector<double> x, const std::string& where) {
  constexpr double kStep = 0.05, kShare = 0.05;   // of the logarithm; of the rows
  constexpr std::ptrdiff_t kBeside = 5;           // rows: one alone is no level
  constexpr long kApart = 3;                      // steps
  std::vector<double> smooth;
  for (std::ptrdiff_t i = 0; i < std::ssize(x); ++i)
    smooth.push_back(MedianOf({x.begin() + std::max<std::ptrdiff_t>(0, i - kBeside), x.begin() + std::min(std::ssize(x), i + kBeside + 1)}));
  std::map<long, std::vector<double>> bins;
  for (const double value : smooth)
    if (value > 0.0) bins[std::lround(std::log(value) / kStep)].push_back(value);
  const auto rows_at = [&bins](long bin) { return bins.contains(bin) ? bins.at(bin).size() : 0; };
  std::vector<double> levels;
  for (const auto& [bin, values] : bins) {
    bool is_highest = true;
    for (long k = 1; k <= kApart; ++k) is_highest &= values.size() > rows_at(bin - k) && values.size() >= rows_at(bin + k);
    const double rows = static_cast<double>(values.size() + rows_at(bin - 1) + rows_at(bin + 1));
    if (is_highest && rows > kShare * static_cast<double>(x.size())) levels.push_back(Whole(values, where).front());
  }
  if (levels.empty()) return Whole(x, where);
  for (std::size_t i = 0; i < x.size(); ++i)
    x[i] = *std::ranges::min_element(levels, {}, [&](double level) { return smooth[i] > 0.0 ? std::abs(std::log(smooth[i] / level)) : level; });
  return x;
}

std::vector<double> Unsteady(const std::vector<double>& of_row, const std::vector<double>& time_s, const std::string& where) {
  constexpr double kOff = 0.003, kOffByPrint = 6.0;  // of the speed; of what the digits of the file make of it
  constexpr double kSettling_s = 0.06;
  constexpr std::size_t kFewestRows = 3;
  std::vector<double> speed = of_row;
  std::ranges::replace_if(speed, [](double v) { return !std::isfinite(v); }, 0.0);  // at no level, nor are those behind it
  std::vector<double> off = Levels(speed, where);
  off.resize(speed.size(), off.front());  // one for all where none is kept
  std::map<double, std::vector<double>> kept;  // by level, which is a rounded one
  for (std::size_t i = 0; i < speed.size(); ++i) kept[off[i]].push_back(speed[i]);
  std::map<double, double> usual;
  for (auto& [level, speeds] : kept) usual[level] = MedianOf(std::move(speeds));
  for (std::size_t i = 0; i < speed.size(); ++i) off[i] = std::abs(speed[i] / usual.at(off[i]) - 1.0);
  const double most = std::max(kOff, kOffByPrint * MedianOf(off));
  std::vector<double> unsteady(speed.size(), 0.0);
  for (std::size_t i = 0; i < speed.size(); ++i) {
    if (off[i] <= most) continue;
    for (std::size_t k = i; k < speed.size() && (k - i <= kFewestRows || time_s[k] - time_s[i] < kSettling_s); ++k) unsteady[k] = 1.0;
  }
  return unsteady;
}

std::vector<double> ByIndex(const std::vector<double>& pulse, const std::vector<double>& time_s, const std::string& where) {
  const auto [low, high] = std::ranges::minmax(pulse);
  std::vector<std::size_t> rises;
  for (std::size_t i = 1; i < pulse.size(); ++i)
    if (pulse[i] > 0.5 * (low + high) && !(pulse[i - 1] > 0.5 * (low + high))) rises.push_back(i);
  if (rises.size() < 3) throw InputError(where, fmt::format("the index rises {} times", rises.size()), "a pulse a turn, over three turns at least");
  std::vector<double> angle_deg(pulse.size());
  for (std::size_t i = 0, turn = 0; i < pulse.size(); ++i) {
    while (turn + 2 < rises.size() && i >= rises[turn + 1]) ++turn;
    const double begin_s = time_s[rises[turn]], whole_s = time_s[rises[turn + 1]] - begin_s;
    angle_deg[i] = 360.0 * (static_cast<double>(turn) + (time_s[i] - begin_s) / whole_s);
  }
  return angle_deg;
}

}  // namespace twinbench::imports
