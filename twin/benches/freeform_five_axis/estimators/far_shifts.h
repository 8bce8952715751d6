#pragma once

#include <Eigen/Core>
#include <vector>

/// Single values that a fit by least squares would take for as good as the others.
namespace twinbench::benches::freeform::estimators {

struct FarRow {
  Eigen::Index row = 0;
  double off_um = 0.0;  // from the fit of all others
  double times = 0.0;   // the scatter of the others
};

/// Rows that lie farther from the fit of all others than chance has them, the farthest first; none where they are so
/// many that the fit errs and not they, or where few degrees of freedom are left to judge by.
/// @param slopes  Of any rank.
/// @param kinds     Of each row, from 0 on: rows of one kind scatter alike.
/// @param readings  Of each row: with one of its rows a reading is no more looked at.
/// @param least_scatter_um  What a file has in digits.
std::vector<FarRow> FarRows(const Eigen::MatrixXd& slopes, const Eigen::VectorXd& shifts_um, const std::vector<int>& kinds,
                            const std::vector<int>& readings, double least_scatter_um);

}  // namespace twinbench::benches::freeform::estimators
