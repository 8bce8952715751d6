#include "twin/benches/hob_transmission/diagnosis/signals.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "twin/core/units.h"
#include "twin/diagnose/engine/base.h"

namespace twinbench::diagnose::hob {
Eigen::VectorXd HobSignalPhase_rad(const SignalContext& context) {
  return context.hob_lines * context.steady_hob_rad;
}

Eigen::MatrixXd SignalFaults_rad(const SignalContext& context) {
  // The point (cos p + x, sin p + y) turns by y cos p - x sin p; y = ratio sin p + lead cos p.
  const Eigen::ArrayXd p = HobSignalPhase_rad(context).array(), s = p.sin(), c = p.cos();
  Eigen::MatrixXd faults(p.size(), 4);
  faults << c.matrix(), (-s).matrix(), (s * c).matrix(), (c * c).matrix();
  return faults;
}

Eigen::VectorXd Relaxation(const SignalContext& c, double settles_over_rad, double ramp_s) {
  double state = 0.0;
  const auto travel = [&](double way_rad, double sense) {
    const double left = std::exp(-std::max(way_rad, 0.0) / settles_over_rad);
    state = sense + (state - sense) * left;
  };
  const auto beyond_rad = [&](Eigen::Index i) { return 0.5 * ramp_s * std::abs(c.velocity_rad_s[i]); };
  Eigen::VectorXd states(c.Samples());
  travel(beyond_rad(0), c.direction[0]);
  for (Eigen::Index i = 0; i < states.size(); ++i) {
    const double sense = c.direction[i], way_rad = i > 0 ? sense * (c.table_rad[i] - c.table_rad[i - 1]) : 0.0;
    const bool turned = i > 0 && sense != c.direction[i - 1];
    if (turned) travel(beyond_rad(i - 1), -sense);
    travel(turned ? beyond_rad(i - 1) + way_rad : way_rad, sense);
    states[i] = state;
  }
  return states;
}

Eigen::VectorXd TravelSinceReversal_rad(const SignalContext& c) {
  const auto beyond_rad = [&](Eigen::Index i) { return 0.5 * c.ramp_s * std::abs(c.velocity_rad_s[i]); };
  Eigen::VectorXd travel_rad = Eigen::VectorXd::Constant(c.Samples(), beyond_rad(0));
  for (Eigen::Index i = 1; i < travel_rad.size(); ++i) {
    const double way_rad = c.direction[i] * (c.table_rad[i] - c.table_rad[i - 1]);
    const bool onwards = c.direction[i] == c.direction[i - 1];
    travel_rad[i] =
        onwards ? travel_rad[i - 1] + std::max(way_rad, 0.0) : std::max(beyond_rad(i - 1) + way_rad, 0.0);
  }
  return travel_rad;
}

Eigen::MatrixXd SetUps(const SignalContext& context) {
  std::map<int, Eigen::Index> column;
  for (const int setup : context.schedule.setup) column.try_emplace(setup, std::ssize(column));
  Eigen::MatrixXd setups = Eigen::MatrixXd::Zero(context.Samples(), std::ssize(column));
  for (Eigen::Index i = 0; i < setups.rows(); ++i)
    setups(i, column.at(context.schedule.setup[static_cast<std::size_t>(i)])) = 1.0;
  return setups;
}

Eigen::MatrixXd AsRows(const SignalContext& context, const Eigen::MatrixXd& samples, ShownBy shown_by) {
  const Eigen::MatrixXd means = context.groups.Mean(samples);
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(means.rows() * context.channels, means.cols());
  for (Eigen::Index i = 0; i < means.rows(); ++i) {
    if (shown_by != ShownBy::kByInterferometer) rows.row(i * context.channels) = means.row(i);
    if (context.channels > 1 && shown_by != ShownBy::kByEncoders) rows.row(i * context.channels + 1) = means.row(i);
  }
  return rows;
}

}  // namespace twinbench::diagnose::hob
