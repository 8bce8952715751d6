#include "twin/sim/block_course.h"

#include <algorithm>
#include <cmath>

namespace twinbench::sim {

double BlockCourse::At_V(std::size_t channel, double t_s) const {
  const auto last = static_cast<std::ptrdiff_t>(knots_V_.size()) - 1;
  const auto y = [&](std::ptrdiff_t k) { return knots_V_[static_cast<std::size_t>(k)][channel]; };
  const double s = t_s / step_s_;
  if (last == 0) return y(0);
  if (last < 3) {
    const auto k = std::clamp<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(std::floor(s)), 0, last - 1);
    return y(k) + (s - static_cast<double>(k)) * (y(k + 1) - y(k));
  }
  const auto k = std::clamp<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(std::floor(s)) - 1, 0, last - 3);
  const double u = s - static_cast<double>(k);  // the four knots are at 0, 1, 2, 3
  const double a = u * (u - 1.0), b = (u - 2.0) * (u - 3.0);
  return y(k) * (1.0 - u) * b / 6.0 + y(k + 1) * u * b / 2.0 + y(k + 2) * a * (3.0 - u) / 2.0 +
         y(k + 3) * a * (u - 2.0) / 6.0;
}

double BlockCourse::Mean_V(std::size_t channel) const {
  const double first_V = knots_V_.front()[channel];
  if (knots_V_.size() == 1) return first_V;
  double sum_V = 0.5 * (knots_V_.back()[channel] - first_V);  // about the first one, for the sake of its digits
  for (std::size_t k = 1; k + 1 < knots_V_.size(); ++k) sum_V += knots_V_[k][channel] - first_V;
  return first_V + sum_V / static_cast<double>(knots_V_.size() - 1);
}

BlockCourse::Voltages BlockCourse::Means_V() const {
  Voltages mean_V{};
  for (std::size_t c = 0; c < kChannels; ++c) mean_V[c] = Mean_V(c);
  return mean_V;
}

double BlockCourse::Slope_V_s(std::size_t channel) const {
  if (knots_V_.size() == 1) return 0.0;
  return (knots_V_.back()[channel] - knots_V_.front()[channel]) / Duration_s();
}

double BlockCourse::RmsSlope_V_s(std::size_t channel) const {
  if (knots_V_.size() == 1) return 0.0;
  double squares = 0.0;
  for (std::size_t k = 1; k < knots_V_.size(); ++k) {
    const double slope_V_s = (knots_V_[k][channel] - knots_V_[k - 1][channel]) / step_s_;
    squares += slope_V_s * slope_V_s;
  }
  return std::sqrt(squares / static_cast<double>(knots_V_.size() - 1));
}

bool BlockCourse::IsLevel(double within_V) const {
  for (std::size_t c = 0; c < kChannels; ++c) {
    const double mean_V = Mean_V(c);
    const auto is_near = [&](const Voltages& v) { return std::abs(v[c] - mean_V) <= within_V; };
    if (!std::ranges::all_of(knots_V_, is_near)) return false;
  }
  return true;
}

bool BlockCourse::IsStraight(double within_V) const {
  for (std::size_t c = 0; c < kChannels; ++c) {
    const double slope_V_s = Slope_V_s(c);
    for (std::size_t k = 0; k < knots_V_.size(); ++k) {
      const double chord_V = knots_V_.front()[c] + slope_V_s * step_s_ * static_cast<double>(k);
      if (std::abs(knots_V_[k][c] - chord_V) > within_V) return false;
    }
  }
  return true;
}

int StepsOf(Duration block, double shortest_s, int most) {
  if (!std::isfinite(shortest_s)) return 1;
  constexpr int kCubic = 3;
  const double steps = std::ceil(BlockCourse::kKnotsAPeriod * ToSeconds(block) / shortest_s);
  return static_cast<int>(std::clamp(steps, double(kCubic), double(std::max(kCubic, most))));
}

}  // namespace twinbench::sim
