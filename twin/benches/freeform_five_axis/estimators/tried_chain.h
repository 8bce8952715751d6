#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "twin/benches/freeform_five_axis/estimators/pose_chain.h"
#include "twin/benches/freeform_five_axis/estimators/pose_terms.h"
#include "twin/benches/freeform_five_axis/settings.h"

/// A machine's chain of axes that is tried: what its errors would make of displacements, and what they leave.
namespace twinbench::benches::freeform::estimators {

/// One of the displacements read: which reading, and x, y or z.
struct ShiftAt {
  std::size_t read = 0;
  int component = 0;
};

/// Displacements one below the other, with what every term makes of them.
struct ShiftDesign {
  Eigen::MatrixXd slopes;
  Eigen::VectorXd shifts_um;
  std::vector<ShiftAt> of;
};

/// Least squares over some of the terms.
struct ShiftSolution {
  std::vector<Eigen::Index> of;
  Eigen::VectorXd values, u;  // u: of a residual of 1 um
  Eigen::MatrixXd inverse;    // from shifts, and beliefs, to values
  double squares_um2 = 0.0;
  Eigen::Index dof = 0;

  double Residual_um() const { return std::sqrt(squares_um2 / static_cast<double>(std::max<Eigen::Index>(1, dof))); }
};

/// Degrees of freedom: values less those of the terms, of a believed one the part that the readings tell.
/// @param believed, size  Terms whose values are thought to be about zero with this standard deviation, by the
/// residual.
ShiftSolution SolvedFor(const ShiftDesign& design, std::vector<Eigen::Index> free, const std::vector<Eigen::Index>& believed = {},
                        double size = 0.0);

/// A chain at its poses, and what its terms make of the readings.
struct Tried {
  MachineChain chain;
  ChainAtPoses at;
  std::vector<PoseTerm> terms;
  ShiftDesign design;
  std::vector<Eigen::Index> chosen;
  ShiftSolution all;
  Eigen::Index told = 0;  // terms; those behind them are beyond what the poses tell

  double Residual_um() const { return all.Residual_um(); }
};

/// What of the settings and the readings decides how a chain is looked at.
struct Looked {
  const DisplacementSettings& settings;
  const std::vector<ShiftRead>& reads;
  bool on_workpiece = false, is_rigid = false;

  ChainAtPoses At(const MachineChain& chain) const;
  /// @return nothing if it has too many unknowns for the readings.
  bool Try(int highest_order, int possible_order, Tried& tried) const;
};

bool IsFromTool(const DisplacementSettings& settings, const MachineChain& chain);

/// Chains whose set-up, locations and squareness leave least: the usual one first, and all that are not clearly
/// worse than the best.
/// @throws InputError if the commanded positions lie on none, or the readings are too few for any.
std::vector<Tried> BestChains(const Looked& looked);

}  // namespace twinbench::benches::freeform::estimators
