#include "twin/model/follow.h"

#include <algorithm>

#include "twin/core/errors.h"

namespace twinbench::model {

const Point& PointNamed(const Follow& follow, const std::string& name) {
  const auto found = std::ranges::find(follow.Points(), name, &Point::name);
  Require(found != follow.Points().end(), "the bench has no point of that name");
  return *found;
}

Eigen::MatrixXd Slope(const Follow& follow, const Point& point, const std::vector<Disturbance>& disturbances) {
  const auto shown = [&](double step) {
    std::vector<Disturbance> with = disturbances;
    with.push_back({point.name, Eigen::VectorXd::Constant(follow.Readings(), step)});
    return follow.Predict(with);
  };
  return (shown(point.step) - shown(-point.step)) / (2.0 * point.step);
}

}  // namespace twinbench::model
