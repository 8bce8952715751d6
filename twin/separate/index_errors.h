#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "twin/core/compensation_table.h"
#include "twin/core/reading.h"

/// Index errors of a rotary table where they were read: the form in which any bench hands them to a compensation.
namespace twinbench::separate {

struct IndexErrors {
  std::string table;                 // as the scenario names it: "target", "turntable"
  std::vector<double> position_rad;  // distinct nominal angles in [0, 2 pi), ascending
  Eigen::VectorXd value_rad;         // mean of the readings there; turned too far: positive
  std::vector<int> count;            // of readings in each mean
  std::vector<int> group;            // values of one group share a constant that is not known
  double u_reading_rad = kNaN;       // of one reading, from what differs between readings of one place
  double dof = 0.0;                  // behind u_reading_rad
  double u_place_rad = 0.0;          // of what stays at a place and is not the table's: teeth of the reference
  double u_between_rad = 0.0;        // what another measurement shows differently beside noise: its adjustment
  std::vector<double> u_order_rad;   // [k - 1]: of order k's amplitude, by how it differs between turns; empty: not known
  double reversal_rad = kNaN;        // forward less backward in the mean, of what the axis does; NaN: not known
  double u_reversal_rad = kNaN;
  std::optional<CompensationTable> commanded = {};  // was at work while they were read

  Eigen::Index Count() const { return value_rad.size(); }
  /// Variance of the mean at a place from the noise of its readings; 0 where it is not known.
  double NoiseVariance_rad2(std::size_t place) const;
};

/// One reading of an index error.
struct IndexReading {
  int setup = 0;  // readings of one set-up share a constant
  double angle_rad = kNaN;
  double value_rad = kNaN;
};

/// Mean at every place, with the constants of the set-ups estimated from the places that they have in common: least
/// squares, value = place + set-up. Set-ups without a common place end in groups of their own. u_reading_rad is
/// from the residuals; NaN if no place was read often enough. Readings with NaN are left out.
IndexErrors MeansByPlace(const std::vector<IndexReading>& readings);

/// Values at the places less the means of their groups.
Eigen::VectorXd AboutGroups(const IndexErrors& errors, const Eigen::VectorXd& value_rad);

double RootMeanSquare(const Eigen::VectorXd& value_rad);

}  // namespace twinbench::separate
