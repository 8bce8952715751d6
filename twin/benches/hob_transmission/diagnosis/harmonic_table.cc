#include "twin/benches/hob_transmission/diagnosis/harmonic_table.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "twin/benches/hob_transmission/settings.h"
#include "twin/core/linear_algebra.h"
#include "twin/diagnose/engine/candidates.h"
#include "twin/model/signals.h"

namespace twinbench::diagnose::hob {
namespace {

/// An order alone names no cause.
std::string MeaningOf(int order, const TransmissionSettings& train) {
  const auto is = [order](double other) { return std::abs(order - other) < 1e-9; };
  if (order <= 2)
    return order == 1
               ? "once per turn: the table's drive, or its ring off centre; another place of ring and head tells"
               : "twice per turn: the table's drive, or its ring out of round or tilted; heads that are not "
                 "opposite to each other tell";
  if (is(train.HobOrder())) return "once per turn of the hob: its drive, or its encoder off centre";
  if (is(train.gear_teeth))
    return "once a tooth of the gear: the mesh, or the hob's encoder out of round or tilted";
  if (is(train.WormOrder())) return "once per turn of the table's worm";
  return "gears, screws or copying errors of this number, of the table or of its ring";
}

/// In ascending order, those that the rows resolve.
std::set<int> OrdersOfInterest(const HobRun& hob) {
  const int last = LargestOrder(hob.context);
  std::set<int> orders;
  for (int k = 1; k <= std::min(kLowOrders, last); ++k) orders.insert(k);
  const TransmissionSettings& train = hob.context.train;
  for (const double k : {train.HobOrder(), static_cast<double>(train.gear_teeth), train.WormOrder()}) {
    if (k == std::round(k) && k <= last) orders.insert(static_cast<int>(k));
  }
  return orders;
}

}  // namespace

std::vector<Harmonic> HarmonicTable(const HobRun& hob, const NoiseModel& noise) {
  const SignalContext& c = hob.context;
  const std::set<int> orders = OrdersOfInterest(hob);
  const Eigen::MatrixXd setups = SetUps(c);
  Eigen::MatrixXd samples(c.Samples(), 2 * std::ssize(orders) + setups.cols());
  Eigen::Index at = 0;
  for (const int k : orders) samples.middleCols(2 * at++, 2) = model::Wave(k * c.table_rad);
  samples.rightCols(setups.cols()) = setups;
  Eigen::MatrixXd X = c.groups.Mean(samples);
  Eigen::VectorXd y(X.rows());
  for (Eigen::Index i = 0; i < X.rows(); ++i) {
    const Eigen::Index row = i * c.channels;  // of m
    X.row(i) /= noise.sigma[row];
    y[i] = hob.run.residual[row] / noise.sigma[row];
  }
  const Eigen::MatrixXd inverse = GeneralInverseOf(X.transpose() * X);
  const Eigen::VectorXd x = inverse * (X.transpose() * y);
  const double scale2 = (y - X * x).squaredNorm() / std::max<double>(1.0, static_cast<double>(X.rows() - X.cols()));
  std::vector<Harmonic> table;
  at = 0;
  for (const int k : orders) {
    const Eigen::Index first = 2 * at++;
    const Polar polar = PolarOf(x.segment<2>(first), scale2 * inverse.block<2, 2>(first, first));
    table.push_back({k, polar.size, polar.u_size, polar.phase_rad, polar.u_phase_rad, MeaningOf(k, c.train)});
  }
  return table;
}

}  // namespace twinbench::diagnose::hob
