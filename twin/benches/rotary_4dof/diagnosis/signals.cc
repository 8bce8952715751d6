#include "twin/benches/rotary_4dof/diagnosis/signals.h"

#include <cmath>

#include "twin/core/units.h"

namespace twinbench::diagnose::rotary {
namespace {

bool IsCircle(const Schedule& s, Eigen::Index i) {
  return s.phase[static_cast<std::size_t>(i)] == Phase::kFullCircle;
}

}  // namespace

Eigen::VectorXd InCircle(const Schedule& s) {
  Eigen::VectorXd in(s.Readings());
  for (Eigen::Index i = 0; i < in.size(); ++i) in[i] = IsCircle(s, i) ? 1.0 : 0.0;
  return in;
}

Eigen::VectorXd DirectionSignal(const Schedule& s) {
  Eigen::VectorXd direction(s.Readings());
  for (Eigen::Index i = 0; i < direction.size(); ++i) {
    direction[i] = IsCircle(s, i) ? s.direction[static_cast<std::size_t>(i)] : 0.0;
  }
  return direction;
}

Eigen::VectorXd SettlingSignal(const Schedule& s, double settle_s, double time_constant_s) {
  const Eigen::ArrayXd dwell_s = s.dwell_s.array().isFinite().select(s.dwell_s.array(), 0.0);
  return DirectionSignal(s).array() * (-(settle_s + dwell_s) / time_constant_s).exp();
}

Eigen::VectorXd ContinuedTarget_rad(const Schedule& s, bool through_setups) {
  Eigen::VectorXd angle = s.target_rad;
  double offset_rad = 0.0;
  for (Eigen::Index i = 1; i < angle.size(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (s.setup[at] != s.setup[at - 1] && !through_setups) offset_rad = 0.0;
    const double moved_rad = s.target_rad[i] - s.target_rad[i - 1];
    const bool rewound =
        s.direction[at] == s.direction[at - 1] && IsCircle(s, i) && moved_rad * s.direction[at] < -units::kPi;
    if (rewound && s.setup[at] == s.setup[at - 1]) {
      offset_rad += s.direction[at] * 2.0 * units::kPi * std::ceil(std::abs(moved_rad) / (2.0 * units::kPi));
    }
    angle[i] += offset_rad;
  }
  return angle;
}

Eigen::MatrixXd OnChannels(const Eigen::MatrixXd& signals, const Eigen::VectorXd& weight) {
  Eigen::MatrixXd rows(signals.rows() * weight.size(), signals.cols());
  for (Eigen::Index i = 0; i < signals.rows(); ++i) {
    rows.middleRows(i * weight.size(), weight.size()) = weight * signals.row(i);
  }
  return rows;
}

}  // namespace twinbench::diagnose::rotary
