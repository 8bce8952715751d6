#include "twin/benches/encoder_comparison/diagnosis/lag_guess.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "twin/benches/encoder_comparison/diagnosis/memory.h"
#include "twin/core/linear_algebra.h"
#include "twin/model/first_order_lag.h"

namespace twinbench::diagnose::encoder {
namespace {

/// What the reference had so much earlier, by straight lines between its readings; at the beginning of a mounting what it had
/// first.
Eigen::VectorXd Earlier(const SignalContext& c, const Eigen::VectorXd& values, double delay_s) {
  Eigen::VectorXd earlier = values;
  Eigen::Index first = 0, at = 0;  // of the mounting; the last reading that is early enough
  for (Eigen::Index i = 0; i < c.Readings(); ++i) {
    if (i > 0 && c.setup[static_cast<std::size_t>(i)] != c.setup[static_cast<std::size_t>(i - 1)]) first = at = i;
    const double time_s = c.time_s[i] - delay_s;
    while (at + 1 <= i && c.time_s[at + 1] <= time_s) ++at;
    if (time_s <= c.time_s[first] || at == i) {
      earlier[i] = values[at == i ? i : first];
      continue;
    }
    const double share = (time_s - c.time_s[at]) / (c.time_s[at + 1] - c.time_s[at]);
    earlier[i] = std::lerp(values[at], values[at + 1], share);
  }
  return earlier;
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

/// What else a servo is behind by.
struct Also {
  bool acceleration = false, friction = false;
};

/// Courses of the reference that was late, and how well the device's course goes with them.
class LateCourses {
 public:
  LateCourses(const EncoderRun& encoder, const Eigen::VectorXd& shown_rad, Also also = {})
      : encoder_(encoder), shown_rad_(encoder.BesideSetUps(shown_rad)), longest_s_(OneWay_s(encoder.context)), also_(also) {
    if (also_.friction) goes_ = Goes(encoder.context);
  }

  Late At(double delay_s, double lag_s) const {
    const Eigen::MatrixXd columns = ColumnsAt(delay_s, lag_s);
    const Eigen::VectorXd sizes = SolveSymmetric(columns.transpose() * columns, Eigen::VectorXd(columns.transpose() * shown_rad_));
    Late late{{delay_s, lag_s, sizes[0]}, (shown_rad_ - columns * sizes).squaredNorm()};
    if (also_.acceleration) late.guess.per_acceleration_s2 = -sizes[1];
    if (also_.friction) late.guess.friction_rad = -sizes[sizes.size() - 1];
    return late;
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
    const Eigen::VectorXd left_rad = Left_rad(less.guess);
    const double readings = static_cast<double>(left_rad.size()) / MemoryOf(left_rad, encoder_.context.pass);
    return readings * std::log(more.left / less.left) > kStrongly;
  }

 private:
  static constexpr int kSteps = 80;

  Eigen::MatrixXd ColumnsAt(double delay_s, double lag_s) const {
    const SignalContext& c = encoder_.context;
    Eigen::MatrixXd columns(c.Readings(), 1 + (also_.acceleration ? 1 : 0) + (also_.friction ? 1 : 0));
    columns.col(0) = Lagged_rad(c, Earlier(c, c.reference_rad, delay_s), lag_s);
    if (also_.acceleration) columns.col(1) = Earlier(c, c.acceleration_rad_s2, delay_s);
    if (also_.friction) columns.rightCols(1) = Earlier(c, goes_, delay_s);
    for (auto column : columns.colwise()) column = encoder_.BesideSetUps(column);
    return columns;
  }

  Eigen::VectorXd Left_rad(const LagGuess& guess) const {
    const Eigen::MatrixXd columns = ColumnsAt(guess.delay_s, guess.lag_s);
    Eigen::VectorXd left_rad = shown_rad_ - guess.gain * columns.col(0);
    if (also_.acceleration) left_rad += guess.per_acceleration_s2 * columns.col(1);
    if (also_.friction) left_rad += guess.friction_rad * columns.rightCols(1);
    return left_rad;
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
  Also also_;
  Eigen::VectorXd goes_;
};

/// Late by a delay, a lag of first order, or both where that leaves clearly less.
std::optional<Late> BestOf(const LateCourses& courses) {
  constexpr double kPart = 0.05;  // of both: less is what lies between the readings
  const std::optional<Late> delay = courses.Best(true), lag = courses.Best(false);
  if (!delay && !lag) return {};
  const Late best = !lag || (delay && delay->left <= lag->left) ? *delay : *lag;
  const Late both = courses.Both(best);
  const auto [less_s, more_s] = std::minmax(both.guess.delay_s, both.guess.lag_s);
  return less_s > kPart * more_s && courses.IsClearly(both, best) ? both : best;
}

/// With what else the families have, as far as it leaves clearly less. Beside the acceleration a delay and a lag of first order
/// are one.
Late WithFollowingErrors(const std::vector<Family>& families, const EncoderRun& encoder, const Eigen::VectorXd& shown_rad, Late best) {
  const auto has = [&families](const char* effect) { return std::ranges::find(families, effect, &Family::effect) != families.end(); };
  Also also;
  for (auto [member, effect] : {std::pair(&Also::friction, "friction"), {&Also::acceleration, "acceleration_error"}}) {
    if (!has(effect)) continue;
    Also with = also;
    with.*member = true;
    const LateCourses courses(encoder, shown_rad, with);
    const std::optional<Late> delay = courses.Best(true);
    const Late moved = courses.Moved(best, 0.1 * best.guess.delay_s, 0.1 * best.guess.lag_s);
    const Late more = delay && delay->left < moved.left ? *delay : moved;
    if (!courses.IsClearly(more, best)) continue;
    best = more;
    also = with;
  }
  return best;
}

}  // namespace

std::optional<LagGuess> GuessLag(const EncoderRun& encoder, const std::vector<Family>& families) {
  constexpr double kLittle = 0.25, kLess = 0.8;  // of what no delay leaves, and of what the speed does
  const SignalContext& c = encoder.context;
  if (!c.Moves() || !c.has_clock) return {};
  const Eigen::VectorXd shown_rad = c.reference_rad + encoder.run.residual;
  const LateCourses courses(encoder, shown_rad);
  const std::optional<Late> late = BestOf(courses);
  if (!late) return {};
  const Late best = WithFollowingErrors(families, encoder, shown_rad, *late);
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
