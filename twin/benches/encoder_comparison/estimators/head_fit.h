#pragma once

#include <Eigen/Core>
#include <vector>

#include "twin/benches/encoder_comparison/estimators/head_readings.h"
#include "twin/benches/encoder_comparison/estimators/several_heads.h"

/// The steps that both ways to calibrate a ring by its heads have in common.
namespace twinbench::separate::encoder {

/// What is solved for: re and im of C_k of each order, then the zero of each set-up's head.
struct OrdersToFit {
  int highest = 0;
  std::vector<int> orders, setups;

  Eigen::Index Unknowns() const { return 2 * std::ssize(orders) + std::ssize(setups); }
  /// Columns of the curve at an angle.
  Eigen::RowVectorXd CurveRow(double angle_rad) const;
  Eigen::Index ColumnOf(int setup) const;
};

struct HeadSolution {
  Eigen::VectorXd x;
  Eigen::MatrixXd cofactor;  // covariance by unit white noise of one row
  Eigen::MatrixXd rounding;  // covariance by steps that repeat; empty: none
  double rest_rad2 = kNaN;   // sum of squares that the fit leaves
  double dof = 0.0;
  double place_rad2 = 0.0, visits = 1.0;  // of what repeats at one place and the reference sees; readings of a place

  double Variance_rad2() const { return rest_rad2 / dof; }
};

/// Normal equations; what no row determines comes out as zero.
class HeadEquations {
 public:
  explicit HeadEquations(OrdersToFit orders);

  /// A row for each head, less their mean: the angle of the shaft is free.
  void AddStop(const HeadStop& stop);
  /// One row: the first head less the mean of all, as if that had no error of the ring in it.
  void AddFirstAgainstMean(const HeadStop& stop);
  /// One row of the curve at any angle.
  void AddPoint(double angle_rad, int setup, double value_rad);

  HeadSolution Solve();

 private:
  Eigen::RowVectorXd RowOf(double angle_rad, int setup) const;
  void Add(const Eigen::RowVectorXd& row, double value_rad);
  void Gather();

  OrdersToFit orders_;
  Eigen::MatrixXd rows_, normal_;  // rows wait until there are enough of them
  Eigen::VectorXd values_, right_;
  Eigen::Index waiting_ = 0;
  double squares_rad2_ = 0.0;
  int count_ = 0, freed_ = 0;  // rows; angles of the shaft
};

/// Readings, heads, highest order and lost orders; or why there is no curve.
SeveralHeads BeginHeads(const HeadReadings& sorted, const HeadOptions& options);

OrdersToFit OrdersOf(const HeadReadings& sorted, int highest, const std::vector<int>& lost);

/// What of a stop went into the equations: AddStop's rows, or AddFirstAgainstMean's.
enum class StopRows { kAllHeads, kFirstAgainstMean };

/// Enters what the heads' steps round alike whenever a place is passed (RoundingIn).
void AddRounding(const HeadReadings& sorted, const OrdersToFit& orders, StopRows which, const ScaleSteps& steps,
                 HeadSolution& solution);

/// Enters orders above the highest in the ring's covariance (Unresolved).
void AddUnresolved(const HeadReadings& sorted, const OrdersToFit& orders, StopRows which,
                   const HeadSolution& solution, double step_rad, harmonics::HarmonicSeries& ring);

/// The ring's curve with its covariance, and what its lost orders may be.
void EnterCurve(const HeadSolution& solution, const OrdersToFit& orders, SeveralHeads& result);

/// The reference's curve: what is left of each instant once the heads have said where the shaft stood.
void EnterReference(const HeadReadings& sorted, const HeadSolution& solution, const OrdersToFit& orders,
                    SeveralHeads& result);

}  // namespace twinbench::separate::encoder
