#pragma once

#include <Eigen/Core>
#include <span>

#include "twin/investigate/taken_run.h"

namespace twinbench::investigate {

/// A hypothesis with sizes that all runs so far agree on.
struct JointFit {
  Hypothesis hypothesis;  // as fitted
  Eigen::MatrixXd cov;    // of its sizes, in units of their u: correlations
  double chi2 = 0.0;      // of all runs, free unknowns of each run fitted
  double log_evidence = 0.0;
};

/// Sizes of the causes, each where a diagnosis stated an uncertainty, moved until what they leave of all runs
/// together is least (Gauss-Newton, the twin asked for slopes), with the u that all runs leave; parameters without
/// one stay.
///
/// Evidence by Laplace's approximation about the fit: noise known as well as tuning::kPseudoDegrees says, sizes
/// thought of before as their plausible sizes (or as large as they are). A size that ends on a bound, where slopes say
/// little, is summed over instead: a cause that contains another one as its limit is as likely as the room that it
/// leaves itself there.
JointFit FitJointly(const Hypothesis& hypothesis, std::span<const TakenRun> runs, const Means& means);

/// Of what the hypothesis leaves of all these runs with the sizes that it has.
double Chi2Of(const Hypothesis& hypothesis, std::span<const TakenRun> runs, const Means& means);

}  // namespace twinbench::investigate
