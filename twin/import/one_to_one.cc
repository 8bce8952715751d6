#include "twin/import/one_to_one.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/core/errors.h"
#include "twin/import/follows.h"
#include "twin/import/said.h"
#include "twin/import/unit_names.h"

namespace twinbench::imports {
namespace {

constexpr double kLikeOne = 0.2;  // a gain further from 1 is no error of a scale but another quantity
constexpr double kFollows = 0.5;  // correlation below which a device does not follow at all

std::string SumFor(const std::string& shown) {
  return fmt::format("{} = \"[reference column] + [error column]\"", shown);
}

std::string KeysOf(const std::string& column) {
  return BaseOf(column) + "_rad, " + BaseOf(column) + "_arcsec or " + BaseOf(column) + "_mm";
}

}  // namespace

void RequireOneToOne(const Session& session, const std::vector<double>& reference, bool one_place, const BenchFormat& bench,
                     const Map& map) {
  const std::string& name = bench.compared->shown;
  const std::vector<double>& shown = session.value.at(name);
  const auto [low, high] = std::ranges::minmax(shown);
  const std::string source = NameOf(map, name);
  if (low == high)
    throw InputError(source, fmt::format("{} is {:g} in all {} rows: the channel is dead", name, low / UnitAtEnd(name)->to_SI, shown.size()),
                     "another column");
  if (one_place) return;
  const auto [first, last] = std::ranges::minmax(reference);
  if (first == last)
    throw InputError(NameOf(map, bench.compared->reference), "the reference never moves",
                     "another column; for one place from both sides a column \"direction\" of 1 and -1");
  const Following following = FollowingOf(reference, shown);
  const bool one_to_one = std::abs(following.gain - 1.0) <= kLikeOne;
  if (one_to_one && following.correlation > kFollows) return;
  if (std::abs(following.correlation) < kFollows)
    throw InputError(source,
                     fmt::format("{} does not follow {} (correlation {:.2f})", name, bench.compared->reference,
                                 following.correlation),
                     "columns of the same axis; of an error use " + SumFor(name));
  const std::string meaning = MeaningOfGain(following.gain);
  throw InputError(
      source,
      fmt::format("{} follows {} times {:.6g}{}", name, bench.compared->reference, following.gain,
                  meaning.empty() ? "" : ": " + meaning),
      std::abs(following.gain + 1.0) <= kLikeOne
          ? fmt::format("the same sense: {} = \"-{}\"", KeyOf(map, name), ExpressionOf(map, name))
          : fmt::format("the same unit and sense: {} = \"...\" in the unit it has, or {} = \"{} / {:.6g}\"",
                        KeysOf(name), KeyOf(map, name), ExpressionOf(map, name), following.gain));
}

}  // namespace twinbench::imports
