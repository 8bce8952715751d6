#include "twin/diagnose/screen/allan.h"

#include <limits>

namespace twinbench::diagnose::screen {

void AllanVariance::Add(const Eigen::VectorXd& series) {
  const Eigen::Index means = series.size() / length_;
  if (means < 2) return;
  const Eigen::RowVectorXd mean = series.head(means * length_).reshaped(length_, means).colwise().mean();
  sum_ += (mean.tail(means - 1) - mean.head(means - 1)).squaredNorm();
  pairs_ += static_cast<double>(means - 1);
}

double AllanVariance::Value() const {
  return pairs_ > 0.0 ? 0.5 * sum_ / pairs_ : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace twinbench::diagnose::screen
