#include "twin/benches/encoder_comparison/estimators/unresolved.h"

#include <algorithm>
#include <cmath>

#include "twin/core/distributions.h"

namespace twinbench::separate::encoder {
namespace {

using harmonics::Complex;

constexpr int kMostVisible = 4;   // times the highest order are looked at
constexpr int kFolding = 3;       // times the visible ones; what lies above counts with those below
constexpr double kDeviations = 3.0;  // above chance
constexpr std::size_t kFewest = 6;   // orders of the last quarter by which a spectrum has come to its end
constexpr double kMedianOfSquare = 0.6931;  // of the squared amplitude of chance, over its mean

/// Mean over the readings of value exp(-j order th); without values of 1.
Complex MeanOf(const FitRest& rest, double order, bool of_rest) {
  Complex sum = 0.0;
  double count = 0.0;
  for (std::size_t p = 0; p < rest.th_rad.size(); ++p) {
    for (Eigen::Index i = 0; i < rest.th_rad[p].size(); ++i)
      sum += std::polar(1.0, -order * rest.th_rad[p][i]) * (of_rest ? rest.rest_rad[p][i] : 1.0);
    count += static_cast<double>(rest.th_rad[p].size());
  }
  return sum / count;
}

/// What noise, and steps that repeat, make of the square of an order's amplitude in what is left.
double NoiseOfRest_rad2(const FitRest& rest) {
  double count = 0.0;
  for (const Eigen::VectorXd& th_rad : rest.th_rad) count += static_cast<double>(th_rad.size());
  return 4.0 * rest.white_rad2 / count + rest.step_rad * rest.step_rad / 12.0 * 2.0 / std::max(1, rest.visible);
}

/// The least that noise is estimated with so many degrees of freedom, over what it is (one in a hundred, by Wilson and Hilferty).
double LeastNoise(double dof) {
  constexpr double kOneInAHundred = 2.33, kNone = 1e-3;
  return std::pow(std::max(kNone, 1.0 - 2.0 / (9.0 * dof) - kOneInAHundred * std::sqrt(2.0 / (9.0 * dof))), 3);
}

/// Squares of the amplitudes of orders, and what noise makes of each.
struct Spectrum {
  std::vector<int> order;
  std::vector<double> square_rad2, noise_rad2;

  void Add(int k, double square, double noise) {
    order.push_back(k);
    square_rad2.push_back(square);
    noise_rad2.push_back(noise);
  }
  double Level_rad2(double noise_dof) const {
    std::vector<double> level, over_noise;
    for (std::size_t i = 0; i < order.size(); ++i) {
      over_noise.push_back(square_rad2[i] / kMedianOfSquare / noise_rad2[i]);
      level.push_back((square_rad2[i] / kMedianOfSquare - noise_rad2[i]) * order[i] * order[i]);
    }
    const auto count = static_cast<double>(order.size());
    const double by_chance = (1.0 + kDeviations / kMedianOfSquare / std::sqrt(count)) / LeastNoise(noise_dof);
    if (count == 0.0 || !(Median(over_noise) > by_chance)) return 0.0;
    return std::max(0.0, Median(level));
  }
  /// What the level is at most: three standard deviations above its median, by noise and by chance among the orders.
  double Most_rad2() const {
    std::vector<double> level, noise;
    for (std::size_t i = 0; i < order.size(); ++i) {
      level.push_back((square_rad2[i] / kMedianOfSquare - noise_rad2[i]) * order[i] * order[i]);
      noise.push_back(noise_rad2[i] * order[i] * order[i]);
    }
    if (order.size() < kFewest) return INFINITY;
    const double of_median = kDeviations / kMedianOfSquare / std::sqrt(static_cast<double>(order.size()));
    const double middle = std::max(0.0, Median(level));
    return middle + of_median * (middle + Median(noise));
  }
};

/// Which fitted order an order of lines looks like at these angles; 0: a constant, -1: none.
int LooksLike(const FitRest& rest, int order, int highest) {
  constexpr double kAlike = 0.7;
  for (int k = 0; k <= highest; ++k)
    if (std::abs(MeanOf(rest, order - k, false)) > kAlike || std::abs(MeanOf(rest, order + k, false)) > kAlike) return k;
  return -1;
}

void AddLines(const harmonics::HarmonicSeries& series, const FitRest& rest, Unresolved& beyond) {
  const std::vector<int> stand_out = FindLines(series);
  for (const int order : rest.of_lines) {
    if (order <= beyond.visible) continue;
    const int like = LooksLike(rest, order, series.Highest());
    if (like == 0) beyond.hidden.push_back(order);
    if (std::ranges::count(stand_out, like) > 0) beyond.lines.emplace_back(order, std::norm(series.At(like).value));
  }
}

}  // namespace

double Unresolved::Variance_rad2() const {
  double of_lines = 0.0;
  for (const auto& [order, square_rad2] : lines) of_lines += 0.5 * square_rad2;
  return seen_rad2 + of_lines + 0.5 * level_rad2 / (visible + 0.5);  // sum of 1 / order^2
}

Eigen::MatrixXd Unresolved::Waves(const Eigen::VectorXd& th_rad) const {
  std::vector<std::pair<int, double>> parts = lines;
  double squares = 0.0;
  for (int k = visible + 1; k <= kFolding * visible; ++k) squares += std::pow(k, -2);
  for (int k = visible + 1; level_rad2 > 0.0 && k <= kFolding * visible; ++k)
    parts.emplace_back(k, level_rad2 / (k * k) / (visible + 0.5) / squares);
  Eigen::MatrixXd waves(th_rad.size(), 2 * std::ssize(parts));
  for (Eigen::Index i = 0; i < std::ssize(parts); ++i) {
    const auto [order, square_rad2] = parts[static_cast<std::size_t>(i)];
    waves.col(2 * i) = std::sqrt(0.5 * square_rad2) * (order * th_rad.array()).cos();
    waves.col(2 * i + 1) = std::sqrt(0.5 * square_rad2) * (order * th_rad.array()).sin();
  }
  return waves;
}

Unresolved UnresolvedBy(const harmonics::HarmonicSeries& series, const FitRest& rest) {
  const int highest = series.Highest();
  Unresolved beyond{.visible = std::clamp(rest.visible, highest, kMostVisible * highest)};
  Spectrum upper_half, last_quarter;
  const auto add = [&](int k, double square_rad2, double noise_rad2) {
    upper_half.Add(k, square_rad2, noise_rad2);
    if (4 * k > 3 * beyond.visible) last_quarter.Add(k, square_rad2, noise_rad2);
  };
  for (int k = beyond.visible / 2 + 1; k <= highest; ++k) {
    const harmonics::Coefficient& c = series.At(k);
    if (std::isfinite(c.value.real()) && c.cov.allFinite()) add(k, std::norm(c.value), c.cov.trace());
  }
  const double noise_rad2 = NoiseOfRest_rad2(rest), orders = beyond.visible - highest;
  double squares_rad2 = 0.0;
  for (int k = highest + 1; k <= beyond.visible; ++k) {
    const double square_rad2 = 4.0 * std::norm(MeanOf(rest, k, true));
    squares_rad2 += square_rad2;
    if (2 * k > beyond.visible) add(k, square_rad2, noise_rad2);
  }
  if (squares_rad2 > (orders + kDeviations * std::sqrt(orders)) * noise_rad2)
    beyond.seen_rad2 = 0.5 * (squares_rad2 - orders * noise_rad2);
  beyond.level_rad2 = std::min(upper_half.Level_rad2(rest.noise_dof), last_quarter.Most_rad2());
  AddLines(series, rest, beyond);
  return beyond;
}

}  // namespace twinbench::separate::encoder
