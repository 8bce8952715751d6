#include "twin/model/motion.h"

#include <cmath>
#include <utility>
#include <vector>

#include "twin/core/distributions.h"

namespace twinbench::model {
namespace {

/// The longest time between two readings of one motion: some are left out, none is a pause.
double LongestStep_s(const Eigen::VectorXd& time_s) {
  constexpr double kSome = 3.5;  // usual steps
  std::vector<double> steps_s;
  for (Eigen::Index i = 1; i < time_s.size(); ++i) {
    if (time_s[i] > time_s[i - 1]) steps_s.push_back(time_s[i] - time_s[i - 1]);
  }
  return steps_s.empty() ? 0.0 : kSome * Median(std::move(steps_s));
}

}  // namespace

Eigen::VectorXd RateOfChange(const Course& course, const Eigen::VectorXd& values) {
  const double longest_s = LongestStep_s(course.time_s);
  const Eigen::Index last = course.Readings() - 1;
  const auto step_s = [&](Eigen::Index i) { return course.time_s[i] - course.time_s[i - 1]; };
  // Slope from reading i - 1 to i; NaN if they are not of one motion.
  const auto slope = [&](Eigen::Index i) {
    if (i < 1 || i > last) return kNaN;
    const bool is_one = course.setup[static_cast<std::size_t>(i)] == course.setup[static_cast<std::size_t>(i - 1)];
    return is_one && step_s(i) > 0.0 && step_s(i) <= longest_s ? (values[i] - values[i - 1]) / step_s(i) : kNaN;
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

}  // namespace twinbench::model
