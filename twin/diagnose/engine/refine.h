#pragma once

#include <Eigen/Core>

#include "twin/diagnose/engine/scanner.h"

namespace twinbench::diagnose {

struct Pick;

/// Moves the shape of a family (time constants, frequencies) from a grid point to where it explains most, within
/// its bounds and no farther than the neighbouring grid points. Amplitudes and free unknowns are eliminated
/// (variable projection, Golub & Pereyra 1973), so Ceres sees only the shape. The family must have `at`.
///
/// @param data  One run, projected, with `others` taken out.
struct Refined {
  Eigen::VectorXd shape;
  double explained = 0.0;  // of data.power
};
Refined RefineShape(const Family& family, int grid_point, const LinearRun& run, const NoiseModel& noise,
                    const Projector& projector, const Remainder& others, const Projected& data);

/// The pick's signature and how the fitted signature changes with each shape parameter: rows x any, not whitened.
Eigen::MatrixXd WithShapeSlopes(const Family& family, const Pick& pick, const LinearRun& run,
                                const NoiseModel& noise, const Projector& projector, const Eigen::MatrixXd& white);

}  // namespace twinbench::diagnose
