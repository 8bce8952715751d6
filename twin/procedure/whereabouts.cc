#include "twin/procedure/whereabouts.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "twin/core/device_fault.h"

namespace twinbench::procedure {
namespace {

// Where no in-position limit is known, m or rad.
constexpr double kGrosslyOff = 1e-4;
constexpr double kRounding = 1e-9;
constexpr double kTurnedOn = std::numeric_limits<double>::infinity();  // in place of where it was sent

}  // namespace

AxisLimits LimitsOf(const std::vector<AxisLimits>& limits, std::size_t axis) {
  return axis < limits.size() ? limits[axis] : AxisLimits{};
}

void TellSentElsewhere(const MachineAxis& axis, double sent, double commanded) {
  throw DeviceFault(FaultKind::kMoved, axis.name,
                    fmt::format("was sent to {:.6f} {} by us and its controller has {:.6f} {} as its target: somebody else moved or "
                                "stopped it, or changed its zero or units",
                                sent / axis.to_SI(), axis.unit(), commanded / axis.to_SI(), axis.unit()));
}

double RadiusNow_m(const Arc& arc, const std::vector<AxisState>& states) {
  return std::hypot(states[arc.axes[0]].encoder - arc.centre_m[0], states[arc.axes[1]].encoder - arc.centre_m[1]);
}

Whereabouts::Whereabouts(const std::vector<MachineAxis>& axes, const std::vector<AxisLimits>& limits)
    : axes_(axes), limits_(limits), sent_(axes.size(), kNaN) {}

double Whereabouts::Sent(std::size_t axis, const AxisState& state) const {
  if (std::isnan(sent_[axis])) return state.commanded;
  return sent_[axis] == kTurnedOn ? kNaN : sent_[axis];
}

double Whereabouts::Tolerance(std::size_t axis) const {
  const double in_position = LimitsOf(limits_, axis).in_position;
  return std::isfinite(in_position) ? in_position : kGrosslyOff;
}

void Whereabouts::SentRound(const Arc& arc, const std::vector<AxisState>& states) {
  const auto [a, b] = arc.axes;
  const double x_m = Sent(a, states[a]) - arc.centre_m[0], y_m = Sent(b, states[b]) - arc.centre_m[1];
  const double c = std::cos(arc.sweep_rad), s = std::sin(arc.sweep_rad);
  sent_[a] = arc.centre_m[0] + c * x_m - s * y_m;
  sent_[b] = arc.centre_m[1] + s * x_m + c * y_m;
}

void Whereabouts::Released(std::size_t axis) {
  sent_[axis] = kTurnedOn;
}

void Whereabouts::RequireOurs(const std::vector<AxisState>& states) const {
  for (std::size_t k = 0; k < states.size(); ++k) {
    const double in_position = LimitsOf(limits_, k).in_position;
    const double same = (std::isfinite(in_position) ? in_position : kSameTarget) + kRounding;
    if (sent_[k] == kTurnedOn || !(std::abs(states[k].commanded - sent_[k]) > same)) continue;  // nor where either is unknown
    TellSentElsewhere(axes_[k], sent_[k], states[k].commanded);
  }
}

}  // namespace twinbench::procedure
