#pragma once

#include <Eigen/Core>
#include <vector>

#include "twin/separate/separate.h"

namespace twinbench::separate {

/// One stop of one set-up: all readings taken there, with their summed weight.
struct Cell {
  int setup = 0;
  int target = 0;
  Matrix4 weight = Matrix4::Zero();  // inverse covariance, lengths in kLengthUnit_m
};

/// The factorised least-squares problem of one layout and one set of weights. A campaign makes it once and uses it
/// for every run that has the same stops and noise; a solution is then a product of a matrix and a vector.
class Separator {
 public:
  /// Reads grid, set-ups and weights from the motions and factorises. Cost: (9 n + 8 set-ups)^3.
  /// @param scale  Factors on the readings' standard uncertainties by motion [ez, ex, ey, dy].
  /// @throws InputError as FindLayout.
  Separator(const std::vector<Motion>& motions, const BenchGeometry& geometry, const SeparateOptions& options,
            const Vector4& scale = Vector4::Ones());

  /// Separates motions whose usable readings sit at the same places of the vector as those of the constructor.
  /// @throws std::logic_error if they do not (see Fits).
  Separation Separate(const std::vector<Motion>& motions) const;

  /// Whether these motions have the layout of the constructor's.
  bool Fits(const std::vector<Motion>& motions) const;

  const Design& design() const { return layout_.design; }
  const Separability& separability() const { return separability_; }
  bool covariance_known() const { return covariance_known_; }

 private:
  /// One table's part of the solution: which rows, which directions are removed, what covariance is left.
  struct TablePart {
    std::vector<Component> components;
    std::vector<Series> series;
    std::vector<int> columns;  // of Design, stacked by component
    std::vector<bool> usable;  // false: no reading determines this value
    Eigen::MatrixXd removed;   // orthonormal, see LostBasis
    Eigen::MatrixXd cov;       // after removal, lengths in kLengthUnit_m
  };

  void CollectCells(const std::vector<Motion>& motions, const Vector4& scale);
  void Factorise();
  void InvertDefective(const Eigen::MatrixXd& normal);
  TablePart MakePart(Table table) const;
  void FindLostValues(TablePart& part) const;
  std::vector<bool> SupportedColumns() const;

  Eigen::VectorXd SolveIterated(const std::vector<Vector4>& cell_means) const;
  std::vector<Vector4> Predict(const Eigen::VectorXd& x) const;
  Vector4 PredictCell(const Eigen::VectorXd& x, const Cell& cell) const;
  std::vector<Vector4> CellMeans(const std::vector<Motion>& motions) const;
  Eigen::MatrixXd Propagate(const Eigen::MatrixXd& cell_values) const;
  Eigen::MatrixXd SystematicColumns(const std::vector<Motion>& motions) const;
  TableEstimate Estimate(const TablePart& part, Table table, const Eigen::VectorXd& x,
                         const Eigen::MatrixXd& systematic) const;
  void AddResiduals(const std::vector<Motion>& motions, const std::vector<Vector4>& predicted,
                    Separation& result) const;
  Vector4 DegreesOfFreedom() const;

  BenchGeometry geometry_;
  Matrix6 cov_calibration_ = Matrix6::Zero();
  Layout layout_;
  Separability separability_;
  bool covariance_known_ = true;
  std::vector<Matrix4> sample_cov_;   // of each sample, as weighted
  std::vector<std::size_t> cell_of_;  // of each sample
  std::vector<Cell> cells_;
  std::vector<StopModel> models_;  // of each cell
  Eigen::MatrixXd inverse_;        // pseudo-inverse of the normal matrix
  Eigen::MatrixXd extra_null_;     // directions lost because readings are missing
  TablePart target_;
  TablePart reference_;
};

}  // namespace twinbench::separate
