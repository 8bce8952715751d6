#include "twin/diagnose/in_frame.h"

#include "twin/diagnose/engine/projector.h"

namespace twinbench::diagnose {

Eigen::VectorXd LeftInFrame(const LinearRun& extended, const LinearRun& frame, const NoiseModel& noise) {
  const Nuisance &own = extended.nuisance, &other = frame.nuisance;
  if (own.jacobian.cols() != other.jacobian.cols()) return extended.residual;
  const Projector projector(noise.Whiten(extended, own.jacobian), own);
  const Eigen::MatrixXd y = extended.residual;
  const Eigen::VectorXd unknowns = projector.Solve(noise.Whiten(extended, y));
  return extended.residual - own.jacobian * unknowns + other.jacobian * unknowns;
}

}  // namespace twinbench::diagnose
