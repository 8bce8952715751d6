#pragma once

#include <vector>

#include "twin/diagnose/engine/search.h"

namespace twinbench::diagnose {

inline constexpr std::size_t kNone = static_cast<std::size_t>(-1);

/// Signatures of the terms side by side, but for one: rows x amplitudes, SI, not whitened.
Eigen::MatrixXd Signatures(const LinearRun& run, const std::vector<Term>& terms, std::size_t left_out = kNone);

/// Fits the amplitudes of all terms together and fills their `amplitudes` and `cov`.
///
/// The amplitudes are free; their covariance lets every shape move as well (its slopes stand beside the amplitudes,
/// with the catalogue's range as prior; the grid widens it), and scales with the noise that is
/// left, as far as the stated noise is not trusted. Columns of the terms must not be dependent: directions that the
/// data do not resolve are left at zero.
/// @param white  The residual, whitened, rows x 1.
void EstimateTerms(const LinearRun& run, const NoiseModel& noise, const Projector& projector,
                   const Scanner& scanner, const Eigen::MatrixXd& white, std::vector<Term>& terms);

}  // namespace twinbench::diagnose
