#include "twin/diagnose/engine/base.h"

namespace twinbench::diagnose {

Eigen::MatrixXd OnEachChannel(const Eigen::MatrixXd& series, int channels) {
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(series.rows() * channels, series.cols() * channels);
  for (Eigen::Index i = 0; i < series.rows(); ++i) {
    for (int c = 0; c < channels; ++c)
      rows.row(i * channels + c).segment(c * series.cols(), series.cols()) = series.row(i);
  }
  return rows;
}

}  // namespace twinbench::diagnose
