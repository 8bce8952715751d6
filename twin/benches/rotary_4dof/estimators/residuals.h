#pragma once

#include <Eigen/Core>
#include <vector>

#include "twin/benches/rotary_4dof/estimators/normal_inverse.h"
#include "twin/benches/rotary_4dof/estimators/order_inverse.h"
#include "twin/benches/rotary_4dof/estimators/separate.h"

namespace twinbench::separate {

/// Expected sum of squared residuals over variance, by motion: samples minus the leverage of the fit.
Vector4 DegreesOfFreedom(const Weights& weights, const std::vector<StopModel>& models, const NormalInverse& normal);
Vector4 DegreesOfFreedom(const Weights& weights, const std::vector<StopModel>& models, const OrderInverse& inverse);

/// Fills residuals, their rms and chi2, readings and degrees of freedom of a result.
/// @param predicted  PredictCells() of the solution.
void AddResiduals(const std::vector<Motion>& motions, const Layout& layout, const Weights& weights,
                  const Eigen::VectorXd& predicted, const Vector4& dof_of, Separation& result);

/// Factors on the stated uncertainties that the residuals ask for: 1 unless they are too unlikely (Birge), all of them
/// or the means of the passes at a stop of a set-up.
Vector4 StatedNoiseScale(const Separation& result);

/// Factors on AssumedCovariance when no noise is stated: from the residuals, but no less than the model's second
/// order and 1 % of the largest of the four. The four motions are mixtures of the same PSD axes, so that one cannot
/// be a hundred times quieter than another; residuals say so only where they are rounding errors.
Vector4 AssumedNoiseScale(const Separation& result, const BenchGeometry& geometry);

}  // namespace twinbench::separate
