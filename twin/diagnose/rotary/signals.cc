#include "twin/diagnose/rotary/signals.h"

#include <cmath>

#include "twin/core/units.h"

namespace twinbench::diagnose::rotary {
namespace {

bool IsCircle(const Schedule& s, Eigen::Index i) {
  return s.phase[static_cast<std::size_t>(i)] == Phase::kFullCircle;
}

/// Readings without a temperature keep the one before.
Eigen::VectorXd FilledTemperature(const Schedule& s, double reference_degC) {
  Eigen::VectorXd above_K(s.Readings());
  double last = 0.0;
  for (Eigen::Index i = 0; i < above_K.size(); ++i) {
    if (std::isfinite(s.temperature_degC[i])) last = s.temperature_degC[i] - reference_degC;
    above_K[i] = last;
  }
  return above_K;
}

}  // namespace

Eigen::VectorXd InCircle(const Schedule& s) {
  Eigen::VectorXd in(s.Readings());
  for (Eigen::Index i = 0; i < in.size(); ++i) in[i] = IsCircle(s, i) ? 1.0 : 0.0;
  return in;
}

Eigen::VectorXd DriftSignal(const Schedule& s, double curvature) {
  return s.time_s.array() * (1.0 + curvature * (1.0 - s.time_s.array() / units::hour));
}

Eigen::VectorXd CreepSignal(const Schedule& s, double time_constant_s, bool calibration_too) {
  Eigen::VectorXd creep(s.Readings());
  double start_s = 0.0;
  for (Eigen::Index i = 0; i < creep.size(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (i == 0 || s.setup[at] != s.setup[at - 1] || s.phase[at] != s.phase[at - 1]) start_s = s.time_s[i];
    creep[i] = calibration_too || IsCircle(s, i) ? std::log1p((s.time_s[i] - start_s) / time_constant_s) : 0.0;
  }
  return creep;
}

Eigen::VectorXd LaggedTemperature(const Schedule& s, double reference_degC, double lag_s) {
  Eigen::VectorXd above_K = FilledTemperature(s, reference_degC);
  if (lag_s <= 0.0) return above_K;
  Eigen::VectorXd lagged_K = above_K;
  for (Eigen::Index i = 1; i < lagged_K.size(); ++i) {
    const double elapsed_s = std::max(s.time_s[i] - s.time_s[i - 1], 1e-9);
    const double slope_K_s = (above_K[i] - above_K[i - 1]) / elapsed_s;
    const double transient_K = lagged_K[i - 1] - above_K[i - 1] + slope_K_s * lag_s;
    lagged_K[i] = above_K[i] - slope_K_s * lag_s + transient_K * std::exp(-elapsed_s / lag_s);
  }
  return lagged_K;
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

Eigen::MatrixXd ToneSignal(const Schedule& s, double frequency_Hz) {
  Eigen::MatrixXd tone(s.Readings(), 2);
  const Eigen::ArrayXd phase = 2.0 * units::kPi * frequency_Hz * s.time_s.array();
  tone.col(0) = phase.sin();
  tone.col(1) = phase.cos();
  return tone;
}

Eigen::VectorXd StepSignal(const Schedule& s, int onset) {
  Eigen::VectorXd step(s.Readings());
  for (Eigen::Index i = 0; i < step.size(); ++i)
    step[i] = s.reading[static_cast<std::size_t>(i)] >= onset ? 1.0 : 0.0;
  return step;
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

Eigen::VectorXd TravelledTarget_rad(const Schedule& s) {
  Eigen::VectorXd way = Eigen::VectorXd::Zero(s.Readings());
  double before_rad = kNaN;
  for (Eigen::Index i = 0; i < way.size(); ++i) {
    way[i] = i > 0 ? way[i - 1] : 0.0;
    if (!IsCircle(s, i)) continue;
    if (std::isfinite(before_rad)) way[i] += std::abs(s.target_rad[i] - before_rad);
    before_rad = s.target_rad[i];
  }
  return way;
}

Eigen::MatrixXd OnChannels(const Eigen::MatrixXd& signals, const Eigen::VectorXd& weight) {
  Eigen::MatrixXd rows(signals.rows() * weight.size(), signals.cols());
  for (Eigen::Index i = 0; i < signals.rows(); ++i) {
    rows.middleRows(i * weight.size(), weight.size()) = weight * signals.row(i);
  }
  return rows;
}

}  // namespace twinbench::diagnose::rotary
