#include "twin/core/lag.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace twinbench {
namespace {

constexpr std::size_t kMostEntries = 4000, kFewestEntries = 40;

std::vector<double> EveryNth(std::span<const double> values, std::size_t n) {
  std::vector<double> some;
  for (std::size_t i = 0; i < values.size(); i += n) some.push_back(values[i]);
  return some;
}

/// @param correlation  By lag.
std::optional<std::size_t> FirstGood(const std::vector<double>& correlation) {
  constexpr double kAsGood = 0.85, kAgainst = -0.85;  // of the best
  const double best = *std::ranges::max_element(correlation);
  if (!(best > 0.0)) return std::nullopt;
  std::size_t lag = 0;
  for (; correlation[lag] < kAsGood * best; ++lag) {
    if (correlation[lag] < kAgainst * best) return std::nullopt;
  }
  std::size_t peak = lag;
  for (; lag < correlation.size() && correlation[lag] >= kAsGood * best; ++lag) {
    if (correlation[lag] > correlation[peak]) peak = lag;
  }
  return peak;
}

}  // namespace

StraightLine LineThrough(std::span<const double> x, std::span<const double> y) {
  const auto n = static_cast<double>(x.size());
  double sx = 0.0, sy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    sx += x[i];
    sy += y[i];
  }
  double xx = 0.0, xy = 0.0, yy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double dx = x[i] - sx / n, dy = y[i] - sy / n;
    xx += dx * dx;
    xy += dx * dy;
    yy += dy * dy;
  }
  if (xx == 0.0 || yy == 0.0) return {};
  return {xy / xx, xy / std::sqrt(xx * yy)};
}

StraightLine LineAtLag(std::span<const double> x, std::span<const double> y, std::size_t lag) {
  return LineThrough(x.first(x.size() - lag), y.subspan(lag));
}

std::optional<std::size_t> LagOf(std::span<const double> x, std::span<const double> y) {
  if (x.size() < kFewestEntries) return std::nullopt;
  const std::size_t stride = 1 + x.size() / kMostEntries;
  const std::vector<double> some_x = EveryNth(x, stride), some_y = EveryNth(y, stride);
  std::vector<double> correlation;
  for (std::size_t lag = 0; lag <= some_x.size() / 4; ++lag) correlation.push_back(LineAtLag(some_x, some_y, lag).correlation);
  const auto lag = FirstGood(correlation);
  return lag ? std::optional(*lag * stride) : std::nullopt;
}

}  // namespace twinbench
