#include "twin/benches/encoder_comparison/diagnosis/lag_guess.h"

#include <algorithm>
#include <cmath>

#include "twin/core/linear_algebra.h"

namespace twinbench::diagnose::encoder {
namespace {

/// Where the reference was so much earlier, by straight lines between its readings; at the beginning of a mounting where it
/// stood first.
Eigen::VectorXd Earlier_rad(const SignalContext& c, double delay_s) {
  Eigen::VectorXd earlier_rad = c.reference_rad;
  Eigen::Index first = 0, at = 0;  // of the mounting; the last reading that is early enough
  for (Eigen::Index i = 0; i < c.Readings(); ++i) {
    if (i > 0 && c.setup[static_cast<std::size_t>(i)] != c.setup[static_cast<std::size_t>(i - 1)]) first = at = i;
    const double time_s = c.time_s[i] - delay_s;
    while (at + 1 <= i && c.time_s[at + 1] <= time_s) ++at;
    if (time_s <= c.time_s[first] || at == i) {
      earlier_rad[i] = c.reference_rad[at == i ? i : first];
      continue;
    }
    const double share = (time_s - c.time_s[at]) / (c.time_s[at + 1] - c.time_s[at]);
    earlier_rad[i] = std::lerp(c.reference_rad[at], c.reference_rad[at + 1], share);
  }
  return earlier_rad;
}

/// Of the way to and fro: how long it takes one way in the mean.
double OneWay_s(const SignalContext& c) {
  const int ways = 1 + *std::ranges::max_element(c.pass) - *std::ranges::min_element(c.pass);
  return (c.time_s.maxCoeff() - c.time_s.minCoeff()) / ways;
}

struct OneFit {
  double left = 0.0, size = 0.0;
};

/// Of rows by one column.
OneFit FitOne(const Eigen::VectorXd& rows, const Eigen::VectorXd& column) {
  const double size = column.dot(rows) / column.squaredNorm();
  return {(rows - size * column).squaredNorm(), size};
}

}  // namespace

std::optional<LagGuess> GuessLag(const EncoderRun& encoder) {
  constexpr int kSteps = 80;
  constexpr double kLongest = 1.0, kLittle = 0.25, kHalf = 0.5;  // of one way; of what no delay leaves, and of what the speed does
  const SignalContext& c = encoder.context;
  if (!c.Moves() || !c.has_clock) return {};
  const Eigen::VectorXd shown = encoder.BesideSetUps(c.reference_rad + encoder.run.residual);
  const double step_s = kLongest * OneWay_s(c) / kSteps;
  LagGuess best;
  double least = 0.0, none = 0.0;
  int at = 0;
  for (int k = 0; k <= kSteps; ++k) {
    const auto [left, gain] = FitOne(shown, encoder.BesideSetUps(Earlier_rad(c, k * step_s)));
    if (k == 0) none = left;
    if (k > 0 && !(left < least)) continue;
    least = left;
    best = {k * step_s, gain};
    at = k;
  }
  if (at == 0 || at == kSteps || !(least < kLittle * none)) return {};
  Eigen::MatrixXd by_speed(c.Readings(), 2);
  by_speed << encoder.BesideSetUps(c.reference_rad), encoder.BesideSetUps(c.velocity_rad_s);
  const double of_speed = (shown - by_speed * SolveShortest(by_speed, shown)).squaredNorm();
  return least < kHalf * of_speed ? std::optional(best) : std::nullopt;
}

}  // namespace twinbench::diagnose::encoder
