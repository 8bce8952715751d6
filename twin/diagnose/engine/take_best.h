#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "twin/diagnose/engine/search.h"
#include "twin/diagnose/tuning.h"

/// One step of the search: what explains most beside what has been found.
namespace twinbench::diagnose {

inline constexpr double kNever = -1e300;  // log prior
/// Log odds of a shape without a name against a cause of the catalogue that shows the same: of what looks so and is not
/// listed.
inline const double kBehindTheSame = std::log((1.0 - tuning::kListed) / tuning::kListed);

/// What every step of the search needs.
struct SearchProblem {
  const LinearRun& run;
  const NoiseModel& noise;
  const Projector& projector;
  const Scanner& scanner;
  Eigen::VectorXd log_priors;
  double threshold;
  SearchExtent extent;
  Eigen::MatrixXd white;  // the residual, rows x 1

  bool IsNamed(int family) const {
    return scanner.Families()[static_cast<std::size_t>(family)].kind == Kind::kNamed;
  }

  /// The shape without a name is exactly that of the cause, on the same channel.
  bool IsTheSame(const Family& unnamed, const Family& named) const {
    return named.kind == Kind::kNamed && !unnamed.same_as.empty() && named.effect == unnamed.same_as &&
           (named.where == unnamed.where || run.Channels() == 1);
  }
};

/// Signatures of all terms but one, whitened, with the shapes' slopes: a shape that is a little off must not look
/// like a second cause.
/// @param left_out  -1: none.
Eigen::MatrixXd ColumnsWithout(const SearchProblem& problem, const std::vector<Term>& terms, int left_out);

/// The most probable family in a place of its own.
/// @param others    What the columns of the other terms take. @param evidence  Gets that of all families.
Term TakeBest(const SearchProblem& problem, const Deflation& others, Evidence& evidence);

}  // namespace twinbench::diagnose
