#pragma once

#include <Eigen/Core>
#include <variant>
#include <vector>

#include "twin/benches/rotary_4dof/estimators/normal_inverse.h"
#include "twin/benches/rotary_4dof/estimators/order_inverse.h"
#include "twin/benches/rotary_4dof/estimators/separate.h"
#include "twin/benches/rotary_4dof/estimators/table_part.h"
#include "twin/benches/rotary_4dof/estimators/weights.h"

namespace twinbench::separate {

/// The factorised least-squares problem of one layout and one set of weights. A campaign makes it once and uses it
/// for every run that has the same stops and noise; a solution is then a product of a matrix and a vector.
class Separator {
 public:
  /// Reads grid, set-ups and weights from the motions and factorises. Cost: some n log n where few stops are
  /// missing (OrderInverse); else (5 n + 8 set-ups)^3.
  /// @throws InputError as FindLayout.
  Separator(const std::vector<Motion>& motions, const BenchGeometry& geometry, const SeparateOptions& options);

  /// Multiplies the readings' standard uncertainties by `factor`, by motion [ez, ex, ey, dy]. Factorises again
  /// unless all four factors are equal.
  void Rescale(const std::vector<Motion>& motions, const Vector4& factor);

  /// Separates motions whose usable readings sit at the same places of the vector as those of the constructor.
  /// @throws std::logic_error if they do not (see Fits).
  Separation Separate(const std::vector<Motion>& motions) const;

  /// Whether these motions have the layout of the constructor's.
  bool Fits(const std::vector<Motion>& motions) const;

  const Design& design() const { return layout_.design; }
  const Separability& separability() const { return separability_; }
  bool covariance_known() const { return weights_.covariance_known; }

 private:
  void Factorise(const std::vector<Motion>& motions);
  void Invert();
  Eigen::MatrixXd Propagate(const Eigen::MatrixXd& cell_values) const;
  Eigen::VectorXd SolveIterated(const std::vector<Motion>& motions) const;
  Systematic FindSystematic(const std::vector<Motion>& motions, const Vector4& second_order) const;

  BenchGeometry geometry_;
  Matrix6 cov_calibration_ = Matrix6::Zero();
  Layout layout_;
  Separability separability_;
  std::vector<StopModel> models_;  // of each cell
  Vector4 scale_ = Vector4::Ones();
  Weights weights_;
  std::variant<OrderInverse, NormalInverse> normal_ = NormalInverse{};
  Vector4 dof_of_ = Vector4::Zero();
  TablePart target_;
  TablePart reference_;
};

}  // namespace twinbench::separate
