#pragma once

#include "twin/benches/freeform_five_axis/estimators/tried_chain.h"

/// How large the errors of a machine may be, by what was read of it.
namespace twinbench::benches::freeform::estimators {

/// What is taken as it comes, and what is thought to be about zero, with how large it may be.
struct Beliefs {
  std::vector<Eigen::Index> free, believed;
  Eigen::VectorXd sizes;  // of all terms, in residuals; of free ones 1
  double log_likelihood = 0.0;
};

std::vector<Eigen::Index> TermsOfKind(const Tried& tried, TermKind kind);

/// With a drift if the readings are clearly likelier so; far more where errors of the machine may do the same.
Beliefs LikelierBeliefs(const Tried& tried);

}  // namespace twinbench::benches::freeform::estimators
