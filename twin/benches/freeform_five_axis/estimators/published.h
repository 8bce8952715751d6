#pragma once

#include "twin/benches/freeform_five_axis/estimators/identification.h"

namespace twinbench::benches::freeform::estimators {

/// The identification as the patent prints it: every reading becomes a displacement of the probe against the
/// artefact, and Eqs 1 to 3 with cubics are solved for the coefficients. The equations take the pivot for zero and
/// leave the turns of A and B out, and a turn of the probe counts as a displacement.
///
/// Two things are not the patent's: its Rzx Z and -Rzy Z are the squareness errors Szx Z and -Szy Z (there is
/// nothing else in it that makes Z and Y or X oblique), and each set-up has a small motion of its own, as it only
/// has one. Reference: CN 203518952 U (2014), Eqs 1 to 5.
Identification IdentifyPublished(const FreeformSettings& bench, const std::vector<PoseRead>& poses);

/// The displacement that Eqs 1 to 3 give the tip [um]: 3 x poses.
Eigen::Matrix3Xd PublishedErrors_um(const std::vector<PoseRead>& poses, const Eigen::VectorXd& unknowns);

}  // namespace twinbench::benches::freeform::estimators
