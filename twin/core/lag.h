#pragma once

#include <cstddef>
#include <optional>
#include <span>

/// Two series of which one may come later.
namespace twinbench {

struct StraightLine {
  double slope = 0.0;        // y per x, least squares
  double correlation = 0.0;  // -1 to 1; 0 where either stands still
};

/// @param y  As many as x.
StraightLine LineThrough(std::span<const double> x, std::span<const double> y);

/// The same, with y taken `lag` entries later than x.
StraightLine LineAtLag(std::span<const double> x, std::span<const double> y, std::size_t lag);

/// By how many entries y comes later than x, a quarter of them at most: the first lag at which the two go together about as well
/// as they can. Half a period on, something periodic counts the other way: nothing where they go against each other before that.
/// @return nothing, too, of less than 40 entries. To one part in 4000 of long series.
std::optional<std::size_t> LagOf(std::span<const double> x, std::span<const double> y);

}  // namespace twinbench
