#include "twin/diagnose/engine/base.h"

namespace twinbench::diagnose {

Eigen::MatrixXd HStack(const Eigen::MatrixXd& left, const Eigen::MatrixXd& right) {
  Eigen::MatrixXd both(right.rows(), left.cols() + right.cols());
  if (left.cols() > 0) both.leftCols(left.cols()) = left;
  both.rightCols(right.cols()) = right;
  return both;
}

Eigen::MatrixXd OnEachChannel(const Eigen::MatrixXd& series, int channels) {
  if (channels == 1) return series;
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(series.rows() * channels, series.cols() * channels);
  for (Eigen::Index i = 0; i < series.rows(); ++i) {
    for (int c = 0; c < channels; ++c)
      rows.row(i * channels + c).segment(c * series.cols(), series.cols()) = series.row(i);
  }
  return rows;
}

Eigen::MatrixXd PatternMap(const Eigen::MatrixXd& pattern, Eigen::Index k) {
  Eigen::MatrixXd map = Eigen::MatrixXd::Zero(pattern.rows() * k, pattern.cols() * k);
  for (Eigen::Index c = 0; c < pattern.rows(); ++c) {
    for (Eigen::Index p = 0; p < pattern.cols(); ++p)
      map.block(c * k, p * k, k, k).diagonal().setConstant(pattern(c, p));
  }
  return map;
}

}  // namespace twinbench::diagnose
