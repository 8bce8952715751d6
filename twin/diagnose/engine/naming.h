#pragma once

#include <string>
#include <vector>

#include "twin/diagnose/diagnosis.h"
#include "twin/diagnose/engine/search.h"

namespace twinbench::diagnose {

/// No stated probability exceeds this: what no catalogue lists remains possible. Measured by leave-one-cause-out
/// (docs/diagnosis.md).
inline constexpr double kMostProbable = 0.97;
inline constexpr double kNamedFrom = 0.8;
inline constexpr double kTieFrom = 0.95;

/// From what the search found to the four kinds of answer.
struct Naming {
  Verdict verdict = Verdict::kNone;
  std::vector<Cause> causes;
  UnknownPart unknown;
  std::vector<int> lead;  // for each pick of the search the cause that stands for it, -1: structure without a name
};
/// @param threshold  Of the alarm statistic: what remains above it is structure that the causes do not explain.
Naming Name(const SearchResult& found, const std::vector<Family>& families, double threshold);

/// Parameters of a family's fitted member.
std::vector<ParameterEstimate> ParametersOf(const Family& family, const Eigen::VectorXd& shape,
                                            const Eigen::VectorXd& amplitudes, const Eigen::MatrixXd& cov);

}  // namespace twinbench::diagnose
