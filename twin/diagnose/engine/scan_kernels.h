#pragma once

#include <Eigen/Core>

namespace twinbench::diagnose {

/// One row a signature, one column a run: what is done with all runs at a grid point is done along a row.
using RunsByRow = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// A'B. Terms are added in the order of the rows, whatever the processor.
/// @param A  rows x m.
/// @param B  rows x any.
RunsByRow TransposedProduct(const Eigen::Ref<const Eigen::MatrixXd>& A, const RunsByRow& B);

/// sum += factor * values, of so many.
void AddScaled(double factor, const double* values, Eigen::Index count, double* sum);

/// A log Bayes factor for each run: -occam - half ln(1 - (sum_i w_i c2_i) / power), the ratio no less than 1e-12.
/// @param weight  w, one a row of c2.
/// @param c2      p x runs.
/// @param power   One a run.
void LogBayesOf(const Eigen::VectorXd& weight, const RunsByRow& c2, const Eigen::ArrayXd& power, double occam,
                double half, Eigen::ArrayXd& log_bayes);

/// Running log of a mean of exponentials over a grid that arrives point by point.
class LogMean {
 public:
  explicit LogMean(Eigen::Index runs);
  void Add(const Eigen::ArrayXd& values);
  Eigen::ArrayXd Value() const;

 private:
  Eigen::ArrayXd top_, sum_;
  int count_ = 0;
};

}  // namespace twinbench::diagnose
