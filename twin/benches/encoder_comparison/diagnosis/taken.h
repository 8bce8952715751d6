#pragma once

#include <Eigen/Core>

#include "twin/benches/encoder_comparison/diagnosis/encoder_run.h"
#include "twin/model/signals.h"

/// What is asked of a shape before it becomes a candidate; only code_digits.cc and range_ends.cc need it.
namespace twinbench::diagnose::encoder {

/// Squares of the residual that columns take, each mounting's mean put aside.
class Taken {
 public:
  explicit Taken(const EncoderRun& encoder)
      : encoder_(encoder), rows_(encoder.BesideSetUps(encoder.run.residual)) {}

  double All() const { return rows_.squaredNorm(); }
  double By(const Eigen::VectorXd& column) const {
    return SizeOf(column) * encoder_.BesideSetUps(column).dot(rows_);
  }
  double SizeOf(const Eigen::VectorXd& column) const {
    const Eigen::VectorXd beside = encoder_.BesideSetUps(column);
    const double square = beside.squaredNorm();
    return square > 0.0 ? beside.dot(rows_) / square : 0.0;
  }
  /// Of one period.
  double ByWave(const Eigen::VectorXd& angle_rad) const {
    const Eigen::MatrixXd wave = model::Wave(angle_rad);
    const Eigen::VectorXd first = encoder_.BesideSetUps(wave.col(0));
    Eigen::VectorXd second = encoder_.BesideSetUps(wave.col(1));
    if (first.squaredNorm() > 0.0) second -= first * (first.dot(second) / first.squaredNorm());
    return By(first) + By(second);
  }

 private:
  const EncoderRun& encoder_;
  Eigen::VectorXd rows_;
};

}  // namespace twinbench::diagnose::encoder
