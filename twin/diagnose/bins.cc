#include "twin/diagnose/bins.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

namespace twinbench::diagnose {

Bins MakeBins(const Eigen::VectorXd& x, std::size_t most_values, int parts) {
  std::set<double> values;
  for (const double v : x) {
    if (std::isfinite(v)) values.insert(v);
  }
  Bins bins;
  if (values.size() <= most_values) {
    bins.centre.assign(values.begin(), values.end());
    for (const double v : x)
      bins.of_value.push_back(std::isfinite(v) ? static_cast<int>(std::distance(values.begin(), values.find(v)))
                                               : -1);
    return bins;
  }
  const double lowest = *values.begin(), width = (*values.rbegin() - lowest) / parts;
  for (int b = 0; b < parts; ++b) bins.centre.push_back(lowest + (b + 0.5) * width);
  for (const double v : x)
    bins.of_value.push_back(std::isfinite(v) ? std::min(static_cast<int>((v - lowest) / width), parts - 1) : -1);
  return bins;
}

Eigen::VectorXd InTurn_deg(const Eigen::VectorXd& angle_deg) {
  return angle_deg.unaryExpr([](double deg) {
    const double turn = std::fmod(std::round(deg * 1e6) / 1e6, 360.0);
    return turn < 0.0 ? turn + 360.0 : turn;
  });
}

}  // namespace twinbench::diagnose
