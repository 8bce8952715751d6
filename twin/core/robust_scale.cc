#include "twin/core/robust_scale.h"

#include <cmath>

#include "twin/core/distributions.h"

namespace twinbench {

double RobustDeviation(std::vector<double> values) {
  constexpr double kMedianOfNormal = 0.6745;  // of the sizes of a standard normal variable
  if (values.empty()) return 0.0;
  for (double& value : values) value = std::abs(value);
  return Median(std::move(values)) / kMedianOfNormal;
}

double RobustDeviation(const Eigen::Ref<const Eigen::VectorXd>& values) {
  return RobustDeviation(std::vector<double>(values.begin(), values.end()));
}

double RobustNoiseOnCourse(const std::vector<double>& course) {
  std::vector<double> second;
  for (std::size_t i = 2; i < course.size(); ++i) second.push_back(course[i] - 2.0 * course[i - 1] + course[i - 2]);
  return RobustDeviation(std::move(second)) / std::sqrt(1.0 + 4.0 + 1.0);
}

}  // namespace twinbench
