#include <algorithm>
#include <cctype>
#include <map>
#include <string>

#include "twin/import/common.h"
#include "twin/import/stacked.h"

namespace twinbench::imports {
namespace {

/// "dx" and 2 of "dx2", "dx_2", "dx 2 [um]", "ball 2 dx": a name with one number, of one digit, and what it is without.
struct NumberedName {
  std::string base;
  int number = 0;  // 0: none
};

NumberedName NumberedNameOf(const std::string& name) {
  const std::size_t at = name.find_first_of("0123456789");
  if (at == std::string::npos || name.find_first_of("0123456789", at + 1) != std::string::npos || name[at] == '0') return {name, 0};
  std::string base;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const bool is_between = i == at || (i + 1 == at && !std::isalpha(static_cast<unsigned char>(name[i])));
    if (!is_between) base += name[i];
  }
  return {base, name[at] - '0'};
}

/// What the file has of each ball, under the same names but for the number; empty: not of several balls.
std::map<int, std::map<std::string, const Column*>> BallsOf(const Track& track) {
  std::map<int, std::map<std::string, const Column*>> balls;
  for (const Column& column : track.columns) {
    const NumberedName name = NumberedNameOf(column.name);
    if (name.number > 0 && column.IsNumber()) balls[name.number][name.base] = &column;
  }
  const auto is_like_first = [&balls](const auto& ball) {
    return std::ranges::equal(ball.second, balls.begin()->second, {}, [](const auto& c) { return c.first; }, [](const auto& c) { return c.first; });
  };
  const bool are_several = balls.size() > 1 && balls.begin()->second.size() > 1 && std::ranges::all_of(balls, is_like_first);
  return are_several ? balls : std::map<int, std::map<std::string, const Column*>>();
}

}  // namespace

void StackBalls(const Map& map, Track& track) {
  if (std::ranges::find(map.sought, "ball", &Sought::name) == map.sought.end()) return;
  const Track whole = track;
  const auto balls = BallsOf(whole);
  if (balls.empty()) return;
  track.columns.clear();
  for (const Column& column : whole.columns)
    if (NumberedNameOf(column.name).number == 0) track.columns.push_back({column.name, column.unit, {}, column.words});
  for (const auto& [base, column] : balls.begin()->second) track.columns.push_back({base, column->unit, {}, {}});
  track.columns.push_back({"ball", "", {}, {}});
  for (const auto& [number, columns] : balls) {
    auto to = track.columns.begin();
    const auto append = [&to](const std::vector<double>& values) {
      to->value.insert(to->value.end(), values.begin(), values.end());
      ++to;
    };
    for (const Column& column : whole.columns)
      if (NumberedNameOf(column.name).number == 0) append(column.value);
    for (const auto& [base, column] : columns) append(column->value);
    append(std::vector<double>(whole.Rows(), number));
  }
  track.time_s.resize(track.Rows());
  for (std::size_t i = 0; i < track.time_s.size(); ++i) track.time_s[i] = static_cast<double>(i);
  track.clock = "none";  // balls were read beside each other, and stand below each other
}

}  // namespace twinbench::imports
