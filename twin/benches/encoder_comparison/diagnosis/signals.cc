#include "twin/benches/encoder_comparison/diagnosis/signals.h"

#include <algorithm>
#include <cmath>

#include "twin/benches/encoder_comparison/settings.h"
#include "twin/core/distributions.h"
#include "twin/core/units.h"

namespace twinbench::diagnose::encoder {
namespace {

double Sign(double value) {
  return value > 0.0 ? 1.0 : value < 0.0 ? -1.0 : 0.0;
}

/// Behind readings that were left out, on the way to the next one.
Eigen::VectorXd AccelerationOf(const SignalContext& c) {
  constexpr double kLeftOut = 3.5;  // steps
  Eigen::VectorXd acceleration_rad_s2 = Eigen::VectorXd::Zero(c.Readings());
  for (Eigen::Index i = 1; i < c.Readings(); ++i) {
    const double step_s = c.time_s[i] - c.time_s[i - 1];
    const double next_s = i + 1 < c.Readings() ? c.time_s[i + 1] - c.time_s[i] : 0.0;
    const bool is_behind_gap = next_s > 0.0 && step_s > kLeftOut * next_s && c.setup[static_cast<std::size_t>(i)] == c.setup[static_cast<std::size_t>(i + 1)];
    if (is_behind_gap) {
      acceleration_rad_s2[i] = c.velocity_rad_s[i] != 0.0 ? (c.velocity_rad_s[i + 1] - c.velocity_rad_s[i]) / next_s : 0.0;
      continue;
    }
    if (step_s > 0.0) acceleration_rad_s2[i] = (c.velocity_rad_s[i] - c.velocity_rad_s[i - 1]) / step_s;
  }
  return acceleration_rad_s2;
}

/// Of a pair of signals from that of amplitude 1 at the phase of this sine and cosine.
double PhaseError_rad(double y, double x, double sine, double cosine) {
  return std::atan2(y * cosine - x * sine, x * cosine + y * sine);
}

}  // namespace

SignalContext ContextOf(const Schedule& s, const Eigen::VectorXd& device_rad, const DeviceSettings& device) {
  SignalContext context;
  context.reading = s.reading;
  context.setup = s.setup;
  context.pass = s.pass;
  context.direction = s.direction;
  context.since_start_s = s.time_s;
  context.time_s = s.time_s.array() - s.time_s[0];
  context.reference_rad = s.reference_rad;
  context.device_rad = device_rad;
  context.velocity_rad_s = s.velocity_rad_s.array().isFinite().select(s.velocity_rad_s, 0.0);
  context.acceleration_rad_s2 = AccelerationOf(context);
  context.device = device;
  return context;
}

Eigen::VectorXd Goes(const SignalContext& context) {
  const Eigen::Map<const Eigen::VectorXi> sense(context.direction.data(), context.Readings());
  return (context.velocity_rad_s.array() != 0.0).select(sense.cast<double>(), 0.0);
}

Eigen::VectorXd SignalPhase_rad(const SignalContext& context) {
  return context.device.signal_periods * (context.device_rad.array() - context.device.signal_zero_rad);
}

Eigen::VectorXd Sense(const SignalContext& context, bool holds_at_rest) {
  const auto& d = context.direction;
  const auto moving = std::find_if(d.begin(), d.end(), [](int direction) { return direction != 0; });
  double last = moving == d.end() ? 0.0 : *moving;
  Eigen::VectorXd sense(context.Readings());
  for (Eigen::Index i = 0; i < sense.size(); ++i) {
    if (d[i] != 0) last = d[i];
    sense[i] = d[i] != 0 || holds_at_rest ? last : 0.0;
  }
  return sense;
}

std::vector<Eigen::VectorXd> Senses(const SignalContext& context) {
  Eigen::VectorXd way = Eigen::VectorXd::Constant(context.Readings(), context.direction[0]);
  for (Eigen::Index i = 1; i < way.size(); ++i) {
    const double step_rad = context.reference_rad[i] - context.reference_rad[i - 1];
    way[i] = std::abs(step_rad) > units::urad ? Sign(step_rad) : way[i - 1];
  }
  std::vector<Eigen::VectorXd> senses = {Sense(context, true)};
  for (const Eigen::VectorXd& other : {Sense(context, false), way}) {
    if (std::find(senses.begin(), senses.end(), other) == senses.end()) senses.push_back(other);
  }
  return senses;
}

Eigen::VectorXd TravelSinceReversal_rad(const SignalContext& context) {
  Eigen::VectorXd travel_rad = Eigen::VectorXd::Zero(context.Readings());
  const Eigen::VectorXd sense = Sense(context, true);
  for (Eigen::Index i = 1; i < travel_rad.size(); ++i) {
    const double step_rad = context.reference_rad[i] - context.reference_rad[i - 1], way_rad = std::abs(step_rad);
    const bool onwards = sense[i] == sense[i - 1] && step_rad * sense[i] >= 0.0;  // else it went back in between
    travel_rad[i] = onwards ? travel_rad[i - 1] + way_rad : context.Moves() ? way_rad : 0.0;
  }
  return travel_rad;
}

double RunUp_rad(const SignalContext& context) {
  if (context.Moves() || context.Readings() < 2) return 0.0;
  std::vector<double> steps_rad;
  for (Eigen::Index i = 1; i < context.Readings(); ++i) {
    const double step_rad = std::abs(context.reference_rad[i] - context.reference_rad[i - 1]);
    if (context.pass[i] == context.pass[i - 1] && step_rad > 0.0) steps_rad.push_back(step_rad);
  }
  if (!steps_rad.empty()) return 0.5 * Median(std::move(steps_rad));
  // At one place from both sides: from farther away than any gap is wide.
  const auto& d = context.direction;
  return std::ranges::count(d, 1) > 0 && std::ranges::count(d, -1) > 0 ? 0.5 * units::turn : 0.0;
}

Eigen::VectorXd Standing_s(const SignalContext& c) {
  constexpr double kStands_rad = 1e-3 * units::deg;  // a reference at rest moves by its noise
  Eigen::VectorXd standing_s = Eigen::VectorXd::Zero(c.Readings());
  for (Eigen::Index i = 1; i < standing_s.size(); ++i) {
    const bool came_back = c.direction[i] * c.direction[i - 1] < 0;  // to the same stop
    if (came_back || std::abs(c.reference_rad[i] - c.reference_rad[i - 1]) > kStands_rad) continue;
    standing_s[i] = standing_s[i - 1] + c.time_s[i] - c.time_s[i - 1];
  }
  return standing_s;
}

Eigen::VectorXd Settling(const SignalContext& c, double time_constant_s) {
  const Eigen::VectorXd standing_s = Standing_s(c);
  const bool has_run_up = RunUp_rad(c) > 0.0;
  Eigen::VectorXd left(c.Readings());
  double sense = has_run_up ? c.direction[0] : 0.0;
  for (Eigen::Index i = 0; i < left.size(); ++i) {
    if (i > 0 && standing_s[i] == 0.0)
      sense = has_run_up ? c.direction[i] : Sign(c.reference_rad[i] - c.reference_rad[i - 1]);
    left[i] = sense * std::exp(-standing_s[i] / time_constant_s);
  }
  return left;
}

Eigen::VectorXd Play(const SignalContext& context, double crossed_over_rad, double start, double run_up_rad) {
  const double half_rad = 0.5 * crossed_over_rad;
  double follower_rad = context.reference_rad[0] + start * half_rad;
  const auto drag = [&](double shaft_rad) {
    follower_rad = std::clamp(follower_rad, shaft_rad - half_rad, shaft_rad + half_rad);
  };
  Eigen::VectorXd behind(context.Readings());
  for (Eigen::Index i = 0; i < behind.size(); ++i) {
    drag(context.reference_rad[i] - context.direction[i] * run_up_rad);
    drag(context.reference_rad[i]);
    behind[i] = (follower_rad - context.reference_rad[i]) / crossed_over_rad;
  }
  return behind;
}

Eigen::MatrixXd Relaxation(const SignalContext& context, double settles_over_rad, double run_up_rad) {
  double at_rad = context.reference_rad[0] - context.direction[0] * run_up_rad, state = 0.0, first = 1.0;
  const auto travel_to = [&](double to_rad) {
    const double sense = Sign(to_rad - at_rad), left = std::exp(-std::abs(to_rad - at_rad) / settles_over_rad);
    state = sense == 0.0 ? state : sense + (state - sense) * left;
    first *= left;
    at_rad = to_rad;
  };
  Eigen::MatrixXd states(context.Readings(), 2);
  for (Eigen::Index i = 0; i < states.rows(); ++i) {
    travel_to(context.reference_rad[i] - context.direction[i] * run_up_rad);
    travel_to(context.reference_rad[i]);
    states.row(i) << state, first;
  }
  return states;
}

Eigen::VectorXd SignalError_rad(const Eigen::VectorXd& phase_rad, const SignalFaults& f) {
  const double in_phase = (1.0 + f.ratio) * std::cos(f.quadrature_rad),
               across = (1.0 + f.ratio) * std::sin(f.quadrature_rad);
  return phase_rad.unaryExpr([&](double p) {
    const double sine = std::sin(p), cosine = std::cos(p);
    const double y = in_phase * sine + across * cosine + f.offset_sin, x = cosine + f.offset_cos;
    return PhaseError_rad(std::clamp(y, -f.level, f.level), std::clamp(x, -f.level, f.level), sine, cosine);
  });
}

Eigen::VectorXd ClippingError_rad(const Eigen::VectorXd& phase_rad, double level) {
  return phase_rad.unaryExpr([level](double p) {
    const double sine = std::sin(p), cosine = std::cos(p);
    if (std::max(std::abs(sine), std::abs(cosine)) <= level) return 0.0;
    return PhaseError_rad(std::clamp(sine, -level, level), std::clamp(cosine, -level, level), sine, cosine);
  });
}

}  // namespace twinbench::diagnose::encoder
