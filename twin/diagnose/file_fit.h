#pragma once

#include <functional>

#include "twin/diagnose/diagnose.h"

namespace twinbench::diagnose {

/// What the scenario that a diagnosis writes takes from the residuals, by row [SI].
using RemovedBy = std::function<Eigen::VectorXd(const DiagnosisRun& found)>;

/// Causes are found to first order, and a twin need not be: an offset of signals of 0.4 shows harmonics of its own,
/// which then were found as further causes. Sizes are therefore moved until the written scenario explains as much
/// as it can, a few times by what the signatures make of what it leaves; a cause that then is not three standard
/// uncertainties from nothing, and is not missed, is left out.
/// @param removed  By `found` as it came; as it is left.
void FitThroughFile(const RemovedBy& removed_by, DiagnosisRun& found, Eigen::VectorXd& removed);

/// Power of what is left where so much is taken from the residuals, in units of noise, free unknowns fitted.
double PowerLeft(const DiagnosisRun& found, const Eigen::VectorXd& removed);

}  // namespace twinbench::diagnose
