#include "twin/benches/circular_motion/estimators/found_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <string_view>
#include <utility>

#include "twin/core/linear_algebra.h"
#include "twin/core/units.h"

namespace twinbench::separate::circular {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr std::size_t kEnoughPoints = 2000;

/// One of the axes at a point.
struct AxisAt {
  Eigen::Vector2d shown;  // what a displacement of it shows, weighted
  double at_m, sense, since_s;
};

AxisAt AxisOf(const CirclePoint& p, const CircleErrors& errors, std::size_t axis) {
  const double angle_rad = p.commanded_rad - p.rate_rad_s * errors.lag_s[axis] - static_cast<double>(axis) * 0.5 * units::kPi;
  const double along_rad = std::remainder(p.direction * angle_rad, units::turn);
  const bool down = along_rad >= 0.0;
  const Eigen::Vector2d shown = axis == 0 ? Eigen::Vector2d(std::cos(p.commanded_rad), -std::sin(p.commanded_rad))
                                          : Eigen::Vector2d(std::sin(p.commanded_rad), std::cos(p.commanded_rad));
  return {p.Weights().cwiseProduct(shown), p.radius_m * std::cos(angle_rad), down ? -1.0 : 1.0,
          p.rate_rad_s == 0.0 ? -1.0 : (down ? along_rad : along_rad + units::kPi) / std::abs(p.rate_rad_s)};
}

/// A kind of error with one shape: keys of its sizes, and what they show at an axis.
struct Shaped {
  std::string_view kind;
  Index sizes;  // of each axis
  std::function<void(const AxisAt&, double shape, double* shown)> at;
};

const Shaped& Cyclic() {
  static const Shaped cyclic = {"cyclic", 2, [](const AxisAt& axis, double pitch_m, double* shown) {
                                  const double wave_rad = units::turn * axis.at_m / pitch_m;
                                  shown[0] = std::cos(wave_rad);
                                  shown[1] = std::sin(wave_rad);
                                }};
  return cyclic;
}
const Shaped& Spikes() {
  static const Shaped spikes = {"spike", 1, [](const AxisAt& axis, double time_s, double* shown) {
                                  const double times = axis.since_s / time_s;
                                  shown[0] = axis.since_s < 0.0 ? 0.0 : -axis.sense * times * std::exp(1.0 - times);
                                }};
  return spikes;
}

/// What the readings leave beside everything but one kind, and what that kind explains of it by its shape.
class LeftBeside {
 public:
  LeftBeside(const std::vector<CirclePoint>& points, const CircleFit& fit, const CircleConstants& known, const Shaped& shaped) : shaped_(shaped) {
    const Index unknowns = fit.shared.cov.rows();
    MatrixXd slopes(2 * std::ssize(points), unknowns);
    left_.resize(slopes.rows());
    for (std::size_t i = 0; i < points.size(); ++i) {
      const CirclePoint& p = points[i];
      const Index row = 2 * static_cast<Index>(i);
      slopes.middleRows<2>(row) = p.Weights().asDiagonal() * SlopeOfShown(p, fit, known);
      left_.segment<2>(row) = p.Weights().cwiseProduct(p.Values_m() - Shown_m(p, fit.errors, fit.MountingOf(p.setup), known));
      for (std::size_t axis = 0; axis < 2; ++axis) axes_[axis].push_back(AxisOf(p, fit.errors, axis));
    }
    CircleErrors errors = fit.errors;
    for (std::size_t k = 0; k < fit.fitted.size(); ++k) {
      const CircleUnknown& unknown = CircleUnknowns()[fit.fitted[k]];
      if (unknown.key.find(shaped.kind) == std::string::npos) continue;
      left_ += slopes.col(static_cast<Index>(k)) * unknown.in(errors);
      slopes.col(static_cast<Index>(k)).setZero();
    }
    const VectorXd lengths = slopes.colwise().norm().transpose();
    slopes *= (lengths.array() > 0.0).select(lengths.cwiseInverse(), 0.0).matrix().asDiagonal();
    constexpr double kRounding = std::numeric_limits<double>::epsilon();
    basis_ = OrthonormalBasisOf(slopes, kRounding * static_cast<double>(std::min(slopes.rows(), slopes.cols())));
    left_ -= basis_ * (basis_.transpose() * left_);
  }

  double All() const { return left_.squaredNorm(); }
  double Freedom() const { return static_cast<double>((left_.array() != 0.0).count() - basis_.cols() - 2 * shaped_.sizes); }

  double ExplainedBy(double shape) const {
    MatrixXd columns(left_.size(), 2 * shaped_.sizes);
    std::array<double, 2> shown{};
    for (std::size_t axis = 0; axis < 2; ++axis) {
      for (std::size_t i = 0; i < axes_[axis].size(); ++i) {
        const AxisAt& at = axes_[axis][i];
        shaped_.at(at, shape, shown.data());
        for (Index k = 0; k < shaped_.sizes; ++k)
          columns.block<2, 1>(2 * static_cast<Index>(i), static_cast<Index>(axis) * shaped_.sizes + k) = shown[static_cast<std::size_t>(k)] * at.shown;
      }
    }
    const VectorXd before = columns.colwise().squaredNorm().transpose();
    columns -= basis_ * (basis_.transpose() * columns);
    constexpr double kSeen = 0.01;  // of a column: less is something else
    for (Index k = 0; k < columns.cols(); ++k)
      if (columns.col(k).squaredNorm() < kSeen * before[k]) columns.col(k).setZero();
    const VectorXd sizes = SolveShortest(columns, left_);
    return 2.0 * sizes.dot(columns.transpose() * left_) - (columns * sizes).squaredNorm();
  }

 private:
  const Shaped& shaped_;
  std::array<std::vector<AxisAt>, 2> axes_;
  VectorXd left_;
  MatrixXd basis_;
};

/// Where a function is largest of some values, and then between its neighbours.
double LargestAt(const std::vector<double>& values, const std::function<double(double)>& of) {
  constexpr int kRounds = 3, kBetween = 8;
  std::vector<double> tried = values;
  double best = tried.front();
  for (int round = 0;; ++round) {
    std::vector<double> sizes;
    for (const double value : tried) sizes.push_back(of(value));
    const auto at = static_cast<std::size_t>(std::ranges::max_element(sizes) - sizes.begin());
    best = tried[at];
    if (round == kRounds) return best;
    const double from = tried[at == 0 ? 0 : at - 1], to = tried[std::min(at + 1, tried.size() - 1)];
    tried.clear();
    for (int k = 0; k <= kBetween; ++k) tried.push_back(from + (to - from) * k / kBetween);
    tried.push_back(best);
    std::ranges::sort(tried);
  }
}

struct ShapeAsRead {
  double value, gained = 0.0;  // of what is left, beyond what the one so far explains
};

/// A shape that plainly explains more than the one so far, and much of what is left beyond the stated noise: what is none of these errors has
/// a little of any shape.
ShapeAsRead AsRead(const LeftBeside& left, const std::vector<double>& values, double so_far) {
  constexpr double kClearly = 50.0, kLeastShare = 0.4;  // of what is left by chance; of what is left beyond it
  if (values.size() < 3) return {so_far};
  const double best = LargestAt(values, [&](double shape) { return left.ExplainedBy(shape); });
  const double explained = left.ExplainedBy(best), gained = explained - left.ExplainedBy(so_far);
  const double noise = (left.All() - explained) / std::max(1.0, left.Freedom());
  const bool is_plain = gained > kClearly * noise && explained > kLeastShare * (left.All() - std::min(1.0, noise) * left.Freedom());
  return is_plain ? ShapeAsRead{best, gained} : ShapeAsRead{so_far};
}

/// Of the smallest circle, and of the readings that lie farthest apart on any.
struct Circles {
  double radius_m = INFINITY, apart_m = 0.0, half_turn_s = INFINITY, apart_s = 0.0;
};

Circles CirclesOf(const std::vector<CirclePoint>& points) {
  Circles circles;
  std::vector<double> apart_m, apart_s;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const CirclePoint& p = points[i];
    circles.radius_m = std::min(circles.radius_m, p.radius_m);
    if (p.rate_rad_s != 0.0) circles.half_turn_s = std::min(circles.half_turn_s, units::kPi / std::abs(p.rate_rad_s));
    if (i == 0 || points[i - 1].setup != p.setup || points[i - 1].pass != p.pass) continue;
    const double apart_rad = std::abs(std::remainder(p.commanded_rad - points[i - 1].commanded_rad, units::turn));
    apart_m.push_back(apart_rad * p.radius_m);
    if (p.rate_rad_s != 0.0) apart_s.push_back(apart_rad / std::abs(p.rate_rad_s));
  }
  for (const auto& [all, middle] : {std::pair{&apart_m, &circles.apart_m}, {&apart_s, &circles.apart_s}}) {
    if (all->empty()) continue;
    std::ranges::nth_element(*all, all->begin() + std::ssize(*all) / 2);
    *middle = (*all)[all->size() / 2];
  }
  return circles;
}

/// As far apart as a wave over the circle's diameter that turns by a quarter; not so long that lobes of a circle look like it.
std::vector<double> Pitches_m(const Circles& circles) {
  const double longest_m = std::min(40.0 * units::mm, 0.25 * circles.radius_m), shortest_m = std::max(2.0 * units::mm, 2.0 * circles.apart_m);
  const double step_per_m = 1.0 / (8.0 * circles.radius_m);
  std::vector<double> pitches_m;
  for (double per_m = 1.0 / longest_m; per_m <= 1.0 / shortest_m; per_m += step_per_m) pitches_m.push_back(1.0 / per_m);
  return pitches_m;
}

/// Of the way to the next reversal a tenth at most: longer spikes are backlash and more.
std::vector<double> SpikeTimes_s(const Circles& circles) {
  constexpr double kLongest_s = 1.0, kOfWay = 0.1, kRatio = 1.25;
  std::vector<double> times_s;
  if (!(circles.apart_s > 0.0)) return times_s;
  for (double time_s = circles.apart_s; time_s <= std::min(kLongest_s, kOfWay * circles.half_turn_s); time_s *= kRatio) times_s.push_back(time_s);
  return times_s;
}

}  // namespace

CircleConstants WithShapeAsRead(const std::vector<CirclePoint>& points, const CircleFit& fit, const CircleConstants& known) {
  const Circles circles = CirclesOf(points);
  const std::vector<CirclePoint> some = Thinned(points, kEnoughPoints);
  const ShapeAsRead pitch_m = AsRead({some, fit, known, Cyclic()}, Pitches_m(circles), known.pitch_m);
  const ShapeAsRead time_s = AsRead({some, fit, known, Spikes()}, SpikeTimes_s(circles), known.spike_time_s);
  CircleConstants as_read = known;
  if (pitch_m.gained > time_s.gained)
    as_read.pitch_m = pitch_m.value;
  else
    as_read.spike_time_s = time_s.value;
  return as_read;
}

}  // namespace twinbench::separate::circular
