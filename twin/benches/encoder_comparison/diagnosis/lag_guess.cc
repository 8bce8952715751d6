#include "twin/benches/encoder_comparison/diagnosis/lag_guess.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "twin/benches/encoder_comparison/diagnosis/memory.h"
#include "twin/core/linear_algebra.h"
#include "twin/model/first_order_lag.h"

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

/// What follows those angles with a lag of first order; before the first reading of a mounting the speed was as it is there.
Eigen::VectorXd Lagged_rad(const SignalContext& c, Eigen::VectorXd followed_rad, double lag_s) {
  if (!(lag_s > 0.0)) return followed_rad;
  model::FirstOrderLag lag(lag_s);
  for (Eigen::Index i = 0; i < c.Readings(); ++i) {
    if (i == 0 || c.setup[static_cast<std::size_t>(i)] != c.setup[static_cast<std::size_t>(i - 1)])
      lag.BeginInMotion(c.time_s[i], followed_rad[i], c.velocity_rad_s[i]);
    followed_rad[i] = lag.Next(c.time_s[i], followed_rad[i]);
  }
  return followed_rad;
}

/// Some way of being late, and what it leaves.
struct Late {
  LagGuess guess;
  double left = 0.0;
};

/// Courses of the reference that was late, and how well the device's course goes with them.
class LateCourses {
 public:
  LateCourses(const EncoderRun& encoder, const Eigen::VectorXd& shown_rad)
      : encoder_(encoder), shown_rad_(encoder.BesideSetUps(shown_rad)), longest_s_(OneWay_s(encoder.context)) {}

  Late At(double delay_s, double lag_s) const {
    const Eigen::VectorXd course_rad = CourseOf(delay_s, lag_s);
    const double gain = course_rad.dot(shown_rad_) / course_rad.squaredNorm();
    return {{delay_s, lag_s, gain}, (shown_rad_ - gain * course_rad).squaredNorm()};
  }

  /// The best of one kind; nothing if it is at the end of what was tried.
  std::optional<Late> Best(bool is_delay) const {
    const double step_s = longest_s_ / kSteps;
    Late best = At(0.0, 0.0);
    int at = 0;
    for (int k = 1; k <= kSteps; ++k) {
      const Late late = At(is_delay ? k * step_s : 0.0, is_delay ? 0.0 : k * step_s);
      if (!(late.left < best.left)) continue;
      best = late;
      at = k;
    }
    if (at == kSteps) return {};
    return Moved(best, is_delay ? step_s : 0.0, is_delay ? 0.0 : step_s);
  }

  /// From this one on by ever smaller steps of both, as long as they help.
  Late Moved(Late late, double delay_s, double lag_s) const {
    constexpr int kHalvings = 7, kMostSteps = 20;  // of one length
    for (int halving = 0; halving < kHalvings; ++halving, delay_s *= 0.5, lag_s *= 0.5) {
      for (int step = 0; step < kMostSteps && Step(delay_s, lag_s, late); ++step) {
      }
    }
    return late;
  }

  /// A delay and a lag together.
  Late Both(const Late& from) const { return Moved(from, longest_s_ / kSteps, longest_s_ / kSteps); }

  /// How much more sure than by chance one is that leaves less than another: Kass and Raftery, Bayes factors (1995), beside
  /// the memory of what is left.
  bool IsClearly(const Late& less, const Late& more) const {
    constexpr double kStrongly = 6.0;
    const Eigen::VectorXd left_rad = shown_rad_ - less.guess.gain * CourseOf(less.guess.delay_s, less.guess.lag_s);
    const double readings = static_cast<double>(left_rad.size()) / MemoryOf(left_rad, encoder_.context.pass);
    return readings * std::log(more.left / less.left) > kStrongly;
  }

 private:
  static constexpr int kSteps = 80;

  Eigen::VectorXd CourseOf(double delay_s, double lag_s) const {
    const SignalContext& c = encoder_.context;
    return encoder_.BesideSetUps(Lagged_rad(c, Earlier_rad(c, delay_s), lag_s));
  }

  /// @return false if none of the neighbours leaves less.
  bool Step(double delay_s, double lag_s, Late& late) const {
    const Late from = late;
    for (const auto& [by_s, lag_by_s] : {std::pair(delay_s, 0.0), {-delay_s, 0.0}, {0.0, lag_s}, {0.0, -lag_s}, {delay_s, -lag_s}, {-delay_s, lag_s}}) {
      if (from.guess.delay_s + by_s < 0.0 || from.guess.lag_s + lag_by_s < 0.0 || (by_s == 0.0 && lag_by_s == 0.0)) continue;
      const Late other = At(from.guess.delay_s + by_s, from.guess.lag_s + lag_by_s);
      if (other.left < late.left) late = other;
    }
    return late.left < from.left;
  }

  const EncoderRun& encoder_;
  Eigen::VectorXd shown_rad_;
  double longest_s_;
};

}  // namespace

std::optional<LagGuess> GuessLag(const EncoderRun& encoder) {
  constexpr double kLittle = 0.25, kLess = 0.8;  // of what no delay leaves, and of what the speed does
  const SignalContext& c = encoder.context;
  if (!c.Moves() || !c.has_clock) return {};
  const Eigen::VectorXd shown_rad = c.reference_rad + encoder.run.residual;
  const LateCourses courses(encoder, shown_rad);
  const std::optional<Late> delay = courses.Best(true), lag = courses.Best(false);
  if (!delay && !lag) return {};
  Late best = !lag || (delay && delay->left <= lag->left) ? *delay : *lag;
  constexpr double kPart = 0.05;  // of both: less is what lies between the readings
  const Late both = courses.Both(best);
  const auto [less_s, more_s] = std::minmax(both.guess.delay_s, both.guess.lag_s);
  if (less_s > kPart * more_s && courses.IsClearly(both, best)) best = both;
  if (!(best.left < kLittle * courses.At(0.0, 0.0).left)) return {};
  Eigen::MatrixXd by_speed(c.Readings(), 2);
  by_speed << encoder.BesideSetUps(c.reference_rad), encoder.BesideSetUps(c.velocity_rad_s);
  const Eigen::VectorXd own_rad = encoder.BesideSetUps(shown_rad);
  const double of_speed = (own_rad - by_speed * SolveShortest(by_speed, own_rad)).squaredNorm();
  return best.left < kLess * of_speed ? std::optional(best.guess) : std::nullopt;
}

std::optional<OtherLag> OtherLagOf(const EncoderRun& encoder, const Eigen::VectorXd& shown_rad, bool is_delay) {
  const LateCourses courses(encoder, shown_rad);
  const std::optional<Late> now = courses.Best(is_delay), other = courses.Best(!is_delay);
  if (!now || !other) return {};
  const bool leaves_less = other->left < now->left;
  const bool is_told_apart = leaves_less ? courses.IsClearly(*other, *now) : courses.IsClearly(*now, *other);
  return OtherLag{other->guess, leaves_less, is_told_apart};
}

}  // namespace twinbench::diagnose::encoder
