#include "twin/import/angle_and_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <set>

#include "twin/import/column_words.h"
#include "twin/import/common.h"
#include "twin/import/follows.h"

namespace twinbench::imports {
namespace {

/// Columns beside which nothing else is: an angle, and by how much the device is off there.
struct AngleAndError {
  const Choice *angle = nullptr, *error = nullptr;
};

/// An error is small beside the angle; what goes with it is where the device stands, whatever it is called ("dev").
bool RunsLike(const Column& column, const Column& angle) {
  constexpr double kLike = 0.99, kFar = 0.5;  // of the way
  const auto way = [](const Column& c) {
    const auto [least, most] = std::ranges::minmax(c.value);
    return most - least;
  };
  return way(column) > kFar * way(angle) && FollowingOf(angle.value, column.value).correlation > kLike;
}

/// Nothing where columns are left that may be where the device stands.
AngleAndError Find(const std::vector<Choice>& columns, const std::string& reference, const Map& map) {
  const std::string given = GivenExpression(map, reference);
  const std::set<std::string> taken = Taken(map);
  std::vector<const Choice*> angles, errors;
  for (const Choice& c : columns) {
    if (c.name == given || !taken.contains(c.name)) (IsCalledError(c.name) ? errors : angles).push_back(&c);
  }
  if (angles.size() > 1) std::erase_if(angles, [](const Choice* c) { return IsCounter(*c->column); });
  const auto says_unit = [](const Choice* c) { return UnitNamed(c->column->unit).has_value(); };
  if (std::ranges::count_if(angles, says_unit) == 1) std::erase_if(angles, std::not_fn(says_unit));
  const bool are = angles.size() == 1 && errors.size() == 1 && (given.empty() || given == angles[0]->name);
  return are && !RunsLike(*errors[0]->column, *angles[0]->column) ? AngleAndError{angles[0], errors[0]} : AngleAndError{};
}

}  // namespace

bool TakeAngleAndError(const std::vector<Choice>& columns, const std::vector<std::string>& compared, Map& map,
                       std::vector<std::string>& remarks) {
  if (compared.size() != 2 || IsGiven(map, compared[1])) return false;
  const auto [angle, error] = Find(columns, compared[0], map);
  if (!angle) return false;
  if (!IsGiven(map, compared[0])) Put(compared[0], *angle, "the column beside the " + error->name, map, remarks);
  const auto put = std::ranges::find(map.columns, compared[0], &MappedColumn::column);
  const std::string unit = put->unit;
  const auto own = UnitNamed(error->column->unit), sum = UnitNamed(unit);
  if (!own && !IsNoUnit(error->column->unit)) return false;
  if (!sum || (own && own->dimension != sum->dimension) || put->expression != angle->name) return false;
  const bool is_correction = IsCalledCorrection(error->name);
  const double factor = own ? own->to_SI / sum->to_SI : 1.0;
  map.columns.push_back({compared[1], fmt::format("[{}] {} [{}] * {:.17g}", angle->name, is_correction ? '-' : '+', error->name, factor), unit, ""});
  remarks.push_back(fmt::format("\"{}\" is taken as {} [{}]: {} is the {}", error->name,
                                is_correction ? "the reference less the device, as a correction has it" : "the device less the reference",
                                own ? own->name : sum->name, compared[1], is_correction ? "difference" : "sum"));
  return true;
}

}  // namespace twinbench::imports
