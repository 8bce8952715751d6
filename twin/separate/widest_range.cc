#include "twin/separate/widest_range.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "twin/core/errors.h"

namespace twinbench::separate {
namespace {

// In standard deviations. Of a million numbers one lies beyond 5.
constexpr double kRangeStep = 0.05, kFarthest = 8.0, kWidest = 14.0;
constexpr int kRangeWidths = static_cast<int>(kWidest / kRangeStep) + 1;
constexpr int kNormalPlaces = static_cast<int>((2.0 * kFarthest + kWidest) / kRangeStep) + 1;
constexpr int kStride = 2;          // of the places that are summed over: a smooth bell's sum is exact long before
constexpr double kImpossible = 1e-12;  // narrower ones add nothing to the integrals

double WholePower(double base, int exponent) {
  double power = 1.0;
  for (; exponent > 0; exponent /= 2, base *= base) {
    if (exponent % 2 == 1) power *= base;
  }
  return power;
}

/// Phi at the places -kFarthest, -kFarthest + kRangeStep, ...
std::array<double, kNormalPlaces> NormalBelow() {
  std::array<double, kNormalPlaces> below;
  for (int i = 0; i < kNormalPlaces; ++i) below[static_cast<std::size_t>(i)] = 0.5 * std::erfc((kFarthest - kRangeStep * i) / std::numbers::sqrt2);
  return below;
}

/// P(range of `size` standard normal numbers < w), as a table over w.
class RangeBelow {
 public:
  explicit RangeBelow(int size) {
    static const std::array<double, kNormalPlaces> below = NormalBelow();
    constexpr int kEnd = static_cast<int>(2.0 * kFarthest / kRangeStep);
    for (int i = 0; i <= kEnd; i += kStride) {
      const double x = kRangeStep * i - kFarthest, density = std::exp(-0.5 * x * x) / std::sqrt(2.0 * std::numbers::pi);
      const double* at = below.data() + i;
      for (int w = 0; w < kRangeWidths; ++w) table_[static_cast<std::size_t>(w)] += size * kStride * kRangeStep * density * WholePower(at[w] - at[0], size - 1);
    }
  }

  double operator()(double width) const {
    const double place = width / kRangeStep;
    if (place >= kRangeWidths - 1) return 1.0;
    const auto i = static_cast<std::size_t>(place);
    return std::min(1.0, table_[i] + (place - static_cast<double>(i)) * (table_[i + 1] - table_[i]));
  }

 private:
  std::array<double, kRangeWidths> table_{};
};

/// Samples of one size, by 1 / deviation.
using BySize = std::map<int, std::pair<RangeBelow, std::vector<double>>>;

BySize BySizeOf(const std::vector<NormalSample>& samples) {
  BySize sorted;
  for (const NormalSample& s : samples) {
    if (s.deviation == 0.0) continue;  // its range is 0
    auto found = sorted.find(s.size);
    if (found == sorted.end()) found = sorted.emplace(s.size, std::pair(RangeBelow(s.size), std::vector<double>())).first;
    found->second.second.push_back(1.0 / s.deviation);
  }
  return sorted;
}

double AllBelow(const BySize& samples, double width) {
  double probability = 1.0;
  for (const auto& [size, of_size] : samples) {
    for (const double over_deviation : of_size.second) {
      probability *= of_size.first(width * over_deviation);
      if (probability < kImpossible) return 0.0;
    }
  }
  return probability;
}

}  // namespace

WidestRange WidestOf(const std::vector<NormalSample>& samples) {
  Require(!samples.empty(), "the widest range is one of some");
  for (const NormalSample& s : samples) Require(s.size > 1 && s.deviation >= 0.0 && std::isfinite(s.deviation), "a range is of two numbers and a scale");
  const double scale = std::ranges::max_element(samples, {}, &NormalSample::deviation)->deviation;
  const BySize sorted = BySizeOf(samples);
  double mean = 0.0, square = 0.0;  // integrals of P(widest > w) and 2 w P(widest > w), in units of scale
  for (int i = 0; i < kRangeWidths; ++i) {
    const double width = kRangeStep * i, above = 1.0 - AllBelow(sorted, scale * width);
    mean += kRangeStep * (i == 0 ? 0.5 : 1.0) * above;
    square += kRangeStep * 2.0 * width * above;
  }
  if (sorted.empty()) return {};
  return {scale * mean, scale * std::sqrt(std::max(0.0, square - mean * mean))};
}

}  // namespace twinbench::separate
