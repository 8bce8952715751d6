#pragma once

#include "twin/diagnose/engine/search.h"

namespace twinbench::diagnose {

/// Whether any of the terms is a named wave of one frequency.
bool HasNamedWave(const std::vector<Family>& families, const std::vector<Term>& terms);

/// Probability that a named wave of one frequency is the fundamental of something that repeats as often and is no sine - a pump
/// that switches, a cam -, from what waves of twice to five times its frequency explain of what all terms leave: the odds before
/// (tuning::kNoSine) times the Bayes factor of overtones against none.
///
/// One half of what repeats is thought to be a rectangle of some duty or a saw-tooth: its overtones follow from the
/// fundamental, as far as that is known. The other half has overtones of any phase, a sixth to two thirds as strong as the
/// fundamental. Zero where no wave was found.
/// @param white    The residual, whitened, rows x 1.
/// @param columns  Of all terms, with the slopes of their shapes, whitened.
double ProbabilityOfOvertones(const LinearRun& run, const NoiseModel& noise, const Projector& projector,
                              const std::vector<Family>& families, const Eigen::MatrixXd& white,
                              const std::vector<Term>& terms, const Eigen::MatrixXd& columns);

}  // namespace twinbench::diagnose
