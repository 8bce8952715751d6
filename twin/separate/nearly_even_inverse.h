#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "twin/separate/even_inverse.h"

namespace twinbench::separate::shifts {

/// A generalised inverse of the normal matrix of circles of which some stops weigh other than most of their set-up:
/// missed, or read more often. With the EvenInverse G of the weight that most have, and U U^T what the others lack
/// (or W W^T what they have more),
///
///     (N - U U^T)^-1 = G + G U (I - U^T G U)^-1 U^T G        (Woodbury)
///
/// A value that no reading shows keeps one reading, of whatever value, which fixes it and tells nothing of the others.
/// Cost: a few n log n a stop that differs, to prepare; q n to apply.
class NearlyEvenInverse {
 public:
  /// @param weight  n x set-ups, 0 where nothing was read.
  /// @return nothing if more than some four thousand stops differ, or if what is missing leaves something open.
  static std::optional<NearlyEvenInverse> Of(const std::vector<int>& shifts, const std::vector<int>& rows,
                                             const Eigen::MatrixXd& weight);

  /// Unknowns as EvenInverse has them.
  Eigen::VectorXd Apply(const Eigen::VectorXd& right) const;

  /// The inverse is even() + lacking lacking^T - added added^T; a row an unknown.
  const EvenInverse& even() const { return even_; }
  const Eigen::MatrixXd& lacking() const { return lacking_; }
  const Eigen::MatrixXd& added() const { return added_; }

 private:
  explicit NearlyEvenInverse(EvenInverse even) : even_(std::move(even)) {}

  EvenInverse even_;
  Eigen::MatrixXd lacking_, added_;
};

}  // namespace twinbench::separate::shifts
