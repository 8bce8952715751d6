#pragma once

#include <Eigen/Core>

#include "twin/diagnose/engine/scanner.h"

namespace twinbench::diagnose {

/// Bounds of one shape parameter around a value: the nearest other grid values, within the physical bounds.
struct Range {
  double lower, upper;
};
Range Around(const Shape& shape, double value);

/// A signature, projected, with its best amplitudes.
struct Explained {
  Eigen::MatrixXd projected;
  Eigen::VectorXd amplitudes;
  double power = 0.0;  // of the data that it explains
};
/// @param white  The signature, whitened.
/// @param data   One run, projected, with `others` taken out.
Explained Explain(const Eigen::MatrixXd& white, const Projector& projector, const Deflation& others,
                  const Eigen::VectorXd& data);

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
                    const Projector& projector, const Deflation& others, const Projected& data);

/// Whether WithShapeSlopes has any.
bool HasSlopes(const Family& family, const Eigen::VectorXd& shape);

/// A signature and how its sum, weighted with the fitted amplitudes, changes with each shape parameter: rows x
/// amplitudes and shapes, not whitened.
/// @param columns  The signature at `shape`.
Eigen::MatrixXd WithShapeSlopes(const Family& family, const Eigen::VectorXd& shape, const Eigen::MatrixXd& columns,
                                const Eigen::VectorXd& amplitudes);

}  // namespace twinbench::diagnose
