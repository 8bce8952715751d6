#include <algorithm>
#include <cmath>

#include "twin/core/units.h"
#include "twin/diagnose/encoder/named_parts.h"

namespace twinbench::diagnose::encoder {
namespace {

/// To first order the angle errs by (y error) cos - (x error) sin, in rad of the period.
Family SignalOffset(const SignalContext& c) {
  const Eigen::MatrixXd wave = Wave(SignalPhase_rad(c)) / c.device.signal_periods;
  Eigen::MatrixXd columns(wave.rows(), 2);
  columns << wave.col(0), -wave.col(1);
  return Linear("signal_offset", {"offset_sin", "offset_cos"}, columns);
}

/// Twice per period, half the fault; its phase says which fault it is, if the zero of the signals is known.
/// @param sine  The fault shows as sine of twice the phase, otherwise as cosine.
Family TwicePerPeriod(const SignalContext& c, const std::string& effect, const std::string& parameter, bool sine) {
  const Eigen::MatrixXd wave = 0.5 * Wave(2.0 * SignalPhase_rad(c)) / c.device.signal_periods;
  if (c.device.signal_zero_known) return Linear(effect, {parameter}, wave.col(sine ? 1 : 0));
  Family family = Linear(effect, {parameter, parameter}, wave);
  family.parameters = [effect, parameter](const Eigen::VectorXd&, const Eigen::VectorXd& x,
                                          const Eigen::MatrixXd& cov) {
    const Polar polar = PolarOf(x, cov);
    return std::vector{Estimate(effect, parameter, polar.size, polar.u_size)};
  };
  return family;
}

/// The least depth, 1 - level, whose signal has a tenth of the plausible size: shallower ones are no candidates.
double LeastDepth(const SignalContext& c, double plausible_rad, double deepest) {
  const Eigen::VectorXd phase = Eigen::VectorXd::LinSpaced(3600, 0.0, 2.0 * units::kPi);
  double depth = 1e-4;
  const auto rms = [&] { return ClippingError_rad(phase, 1.0 - depth).norm() / 60.0 / c.device.signal_periods; };
  while (depth < 0.5 * deepest && rms() < 0.1 * plausible_rad) depth *= 1.25;
  return depth;
}

/// The level fixes size and ratios of orders 4, 8, 12; an unknown zero of the signals shifts all of them together.
Family Clipping(const Context& context, double plausible_rad) {
  const SignalContext& c = *context;
  const double quarter_rad = 0.5 * units::kPi;  // the error repeats so
  constexpr int kZeros = 24;                    // 3.75 deg: an eighth of a period of order 12
  Family family = Named("signal_clipping");
  Shape level = ShapeOf("signal_clipping", "level", {});
  constexpr double kDeepest = 0.25;
  level.lower = 0.72;
  level.upper = 0.9999;
  Shape zero{"zero", "deg", units::deg, -units::kPi, units::kPi, {}};
  for (const double depth : Ratios(LeastDepth(c, plausible_rad, kDeepest), kDeepest, 12)) {
    for (int k = 0; k < (c.device.signal_zero_known ? 1 : kZeros); ++k) {
      level.value.push_back(1.0 - depth);
      zero.value.push_back(k * quarter_rad / kZeros);
    }
  }
  family.grid = static_cast<int>(level.value.size());
  family.shapes = {level, zero};
  if (c.device.signal_zero_known) family.shapes.pop_back();
  // One where the signal is as large as the level says; a little freedom for cut-offs that are not quite sharp.
  family.amplitudes = {{"strength", "1", 1.0, 1.0, 0.3, 3.0}};
  family.at = [context](const Eigen::VectorXd& shape) {
    const double zero_rad = shape.size() > 1 ? shape[1] : 0.0;
    const Eigen::VectorXd phase = SignalPhase_rad(*context).array() - zero_rad;
    return Eigen::MatrixXd(ClippingError_rad(phase, shape[0]) / context->device.signal_periods);
  };
  family.columns = [shapes = family.shapes, at = family.at](int g) {
    Eigen::VectorXd shape(std::ssize(shapes));
    for (std::size_t k = 0; k < shapes.size(); ++k) shape[k] = shapes[k].value[static_cast<std::size_t>(g)];
    return at(shape);
  };
  family.parameters = [](const Eigen::VectorXd& shape, const Eigen::VectorXd& x, const Eigen::MatrixXd& cov) {
    return std::vector{Estimate("signal_clipping", "level", shape[0], DeviationAt(cov, x.size()))};
  };
  return family;
}

}  // namespace

void AddSignals(const Context& context, double plausible_rad, std::vector<Family>& families) {
  families.push_back(SignalOffset(*context));
  families.push_back(TwicePerPeriod(*context, "amplitude_mismatch", "ratio", true));
  families.push_back(TwicePerPeriod(*context, "quadrature_error", "angle", false));
  families.push_back(Clipping(context, plausible_rad));
}

}  // namespace twinbench::diagnose::encoder
