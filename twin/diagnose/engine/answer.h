#pragma once

#include <string>
#include <vector>

#include "twin/diagnose/diagnosis.h"
#include "twin/diagnose/engine/search.h"

namespace twinbench::diagnose {

/// What the search holds responsible in one place, in words and numbers.
struct Answer {
  std::vector<Cause> causes;  // several share the place; empty: structure without a name
  double unknown = 0.0;       // probability of all shapes without a name
  std::string signature;      // of the most probable of them
  double weight = 0.0;        // power that nothing else explains
  bool may_be_piece = false;  // of what has no name, which it is like
};

/// Beyond it, one may be a piece of the other.
inline constexpr double kAlike = 0.1;
/// Share of what one shows that the other, in any size, shows as well.
double Likeness(const Eigen::VectorXd& one, const Eigen::VectorXd& other);

/// The catalogue's parameters of a fitted family.
/// @param cov  Of the amplitudes, and of the shape after them as far as it goes.
std::vector<ParameterEstimate> ParametersOf(const Family& family, const Eigen::VectorXd& shape,
                                            const Eigen::VectorXd& amplitudes, const Eigen::MatrixXd& cov);

/// @param k  Which of the terms.
Answer AnswerOf(const SearchResult& found, std::size_t k, const std::vector<Family>& families);

}  // namespace twinbench::diagnose
