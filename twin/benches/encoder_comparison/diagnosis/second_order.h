#pragma once

#include <Eigen/Core>
#include <vector>

#include "twin/benches/encoder_comparison/diagnosis/encoder_run.h"
#include "twin/core/scenario.h"

/// Errors of a device are told to first order: whether a curve goes by the angle that is shown or by that of the
/// shaft, and whether what is late is late by a delay or by a lag, is a matter of the product of two of them.
namespace twinbench::diagnose::encoder {

class SecondOrder {
 public:
  SecondOrder() = default;  // of no effects
  /// Of waves of the device's angle, sums and differences of their orders; of a latency, the acceleration.
  SecondOrder(const std::vector<EffectSettings>& effects, const EncoderRun& encoder);

  bool IsNothing() const { return columns_.cols() == 0; }
  /// Rows, one a reading, that are like what the effects leave out, and no larger than it may be.
  bool MayBe(const Eigen::VectorXd& rows) const;
  /// What of the rows is not like it.
  Eigen::VectorXd Beside(const Eigen::VectorXd& rows) const;

 private:
  Eigen::VectorXd Own(const Eigen::VectorXd& rows) const;

  Eigen::MatrixXd columns_;  // each as large as it is expected, about its mean
  Eigen::VectorXd speed_;    // of length one: what a latency takes itself; empty: none
};

}  // namespace twinbench::diagnose::encoder
