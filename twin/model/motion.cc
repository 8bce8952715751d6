#include "twin/model/motion.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "twin/core/distributions.h"
#include "twin/core/robust_scale.h"

namespace twinbench::model {
namespace {

double LongestStep_s(const Eigen::VectorXd& time_s) {
  std::vector<double> steps_s;
  for (Eigen::Index i = 1; i < time_s.size(); ++i) {
    if (time_s[i] > time_s[i - 1]) steps_s.push_back(time_s[i] - time_s[i - 1]);
  }
  return steps_s.empty() ? 0.0 : kLongestStep * Median(std::move(steps_s));
}

/// Which readings are of one motion.
class Motions {
 public:
  explicit Motions(const Course& course) : motion_(static_cast<std::size_t>(course.Readings())) {
    const double longest_s = LongestStep_s(course.time_s);
    for (std::size_t i = 1; i < motion_.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      const double step_s = course.time_s[at] - course.time_s[at - 1];
      const bool goes_on = course.setup[i] == course.setup[i - 1] && step_s > 0.0 && step_s <= longest_s;
      motion_[i] = motion_[i - 1] + (goes_on ? 0 : 1);
    }
  }
  bool AreOne(Eigen::Index i, Eigen::Index j) const {
    return i >= 0 && j < std::ssize(motion_) && motion_[static_cast<std::size_t>(i)] == motion_[static_cast<std::size_t>(j)];
  }

 private:
  std::vector<int> motion_;
};

/// By how much each value is off the polynomial through two neighbours before and three behind, in units of the noise of
/// one: their median leaves out where a motion is not smooth.
double NoiseOf(const Course& course, const Motions& motions, const Eigen::VectorXd& values) {
  constexpr std::array<Eigen::Index, 5> kBeside = {-2, -1, 1, 2, 3};
  std::vector<double> sizes;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    if (!motions.AreOne(i + kBeside.front(), i + kBeside.back())) continue;
    double off = values[i], squares = 1.0;
    for (const Eigen::Index j : kBeside) {
      double weight = 1.0;
      for (const Eigen::Index k : kBeside)
        if (k != j)
          weight *= (course.time_s[i] - course.time_s[i + k]) / (course.time_s[i + j] - course.time_s[i + k]);
      off -= weight * values[i + j];
      squares += weight * weight;
    }
    sizes.push_back(std::abs(off) / std::sqrt(squares));
  }
  return sizes.empty() ? 0.0 : RobustDeviation(std::move(sizes));
}

/// Value and slope at each reading, and what a deviation of one in every value makes of the slope.
struct Slopes {
  Eigen::VectorXd level, rate, per_noise;
};

/// Of the parabola through `half` neighbours on either side, as many on both as there are; NaN where it has none.
Slopes SlopesOver(Eigen::Index half, const Course& course, const Motions& motions, const Eigen::VectorXd& values) {
  const Eigen::VectorXd none = Eigen::VectorXd::Constant(values.size(), kNaN);
  Slopes slopes{none, none, none};
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    Eigen::Index beside = 0;
    while (beside < half && motions.AreOne(i - beside - 1, i + beside + 1)) ++beside;
    if (beside == 0) continue;
    const Eigen::ArrayXd t = course.time_s.segment(i - beside, 2 * beside + 1).array() - course.time_s[i];
    const Eigen::ArrayXd y = values.segment(i - beside, 2 * beside + 1).array() - values[i];
    const double count = static_cast<double>(t.size());
    Eigen::Matrix3d normal;
    normal << count, t.sum(), t.square().sum(), t.sum(), t.square().sum(), t.cube().sum(), t.square().sum(), t.cube().sum(),
        t.square().square().sum();
    const Eigen::Matrix3d inverse = normal.inverse();
    const Eigen::Vector3d moments(y.sum(), (t * y).sum(), (t.square() * y).sum());
    slopes.level[i] = values[i] + inverse.row(0).dot(moments);
    slopes.rate[i] = inverse.row(1).dot(moments);
    slopes.per_noise[i] = std::sqrt(inverse(1, 1));
  }
  return slopes;
}

/// Takes what neighbours say of each value, but for those about one that is farther off them than noise is: a motion that
/// turns has a corner there.
void TakeWhereSmooth(const Slopes& slopes, Eigen::Index half, double noise, SteadyCourse& steady) {
  constexpr double kFar = 4.5;
  const Eigen::VectorXd plain = steady.values;
  Eigen::Index corner = -half - 1;  // the last one
  for (Eigen::Index ahead = 0; ahead < plain.size() + half; ++ahead) {
    if (ahead < plain.size() && std::abs(slopes.level[ahead] - plain[ahead]) > kFar * noise) corner = ahead;
    const Eigen::Index i = ahead - half;
    if (i < 0 || corner >= i - half || !std::isfinite(slopes.level[i])) continue;
    steady.values[i] = slopes.level[i];
    steady.rate[i] = slopes.rate[i];
  }
}

/// Neighbours on either side see no more of a value than its noise, unless something goes faster than they do.
bool MoreThanNoise(const Eigen::VectorXd& off, double noise) {
  constexpr double kMore = 1.1;
  std::vector<double> sizes;
  for (const double v : off)
    if (std::isfinite(v)) sizes.push_back(std::abs(v));
  return !sizes.empty() && RobustDeviation(std::move(sizes)) > kMore * noise;
}

double RmsOfFinite(const Eigen::ArrayXd& values) {
  const Eigen::ArrayXd known = values.isFinite().select(values, 0.0);
  return std::sqrt(known.square().sum() / std::max(1.0, static_cast<double>(values.isFinite().count())));
}

}  // namespace

Eigen::VectorXd RateOfChange(const Course& course, const Eigen::VectorXd& values) {
  const Motions motions(course);
  const Eigen::Index last = course.Readings() - 1;
  const auto step_s = [&](Eigen::Index i) { return course.time_s[i] - course.time_s[i - 1]; };
  // Slope from reading i - 1 to i; NaN if they are not of one motion.
  const auto slope = [&](Eigen::Index i) {
    return motions.AreOne(i - 1, i) ? (values[i] - values[i - 1]) / step_s(i) : kNaN;
  };
  // At an end: of the step there, and as much further as the slope has changed from the next one.
  const auto at_end = [&](Eigen::Index near, Eigen::Index next) {
    if (!std::isfinite(slope(near))) return 0.0;
    if (!std::isfinite(slope(next))) return slope(near);
    return slope(near) + (slope(near) - slope(next)) * step_s(near) / (step_s(near) + step_s(next));
  };
  Eigen::VectorXd rate(last + 1);
  for (Eigen::Index i = 0; i <= last; ++i) {
    const double before = slope(i), behind = slope(i + 1);
    if (std::isfinite(before) && std::isfinite(behind)) {
      rate[i] = (before * step_s(i + 1) + behind * step_s(i)) / (step_s(i) + step_s(i + 1));
    } else {
      rate[i] = std::isfinite(before) ? at_end(i, i - 1) : at_end(i + 1, i + 2);
    }
  }
  return rate;
}

SteadyCourse SteadyCourseOf(const Course& course, const Eigen::VectorXd& values) {
  constexpr double kSmall = 0.01;
  constexpr Eigen::Index kWidest = 32;
  SteadyCourse steady{values, RateOfChange(course, values)};
  const Motions motions(course);
  const double noise = NoiseOf(course, motions, values), small = kSmall * RmsOfFinite(steady.rate);
  Eigen::Index half = 1;
  Slopes slopes = SlopesOver(half, course, motions, values);
  while (noise * RmsOfFinite(slopes.per_noise) > small && half < kWidest) {
    Slopes wider = SlopesOver(2 * half, course, motions, values);
    if (MoreThanNoise(wider.level - values, noise)) break;
    slopes = std::move(wider);
    half *= 2;
  }
  steady.is_smoothed = half > 1;
  if (steady.is_smoothed) TakeWhereSmooth(slopes, half, noise, steady);
  return steady;
}

}  // namespace twinbench::model
