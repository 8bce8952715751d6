#include <algorithm>
#include <cmath>

#include "twin/core/units.h"
#include "twin/diagnose/hob/family_parts.h"

namespace twinbench::diagnose::hob {
namespace {

/// A drift or a vibration may be the table's, or of the way in which its encoder is held: both count as one cause.
std::vector<Seen> Ways(const SignalContext& c) {
  return c.channels > 1 ? std::vector{Seen::kByBoth, Seen::kByEncoders} : std::vector{Seen::kByBoth};
}

/// Amplitudes: the rate, and the rate times the share of the quadratic part.
Family Drift(const Context& context, Seen seen) {
  Family family = NamedFamily("drift");
  family.amplitudes.assign(2, AmplitudeOf("drift", "rate"));
  family.amplitudes[1].name = "bend";
  Use(context, {BaseOf(context, 1, [signals = DriftSignals_s(*context)](int) { return signals; }), seen}, family);
  family.parameters = [](const Eigen::VectorXd&, const Eigen::VectorXd& x, const Eigen::MatrixXd& cov) {
    const double curvature = x[1] / x[0];
    const Eigen::Vector2d slope(-curvature / x[0], 1.0 / x[0]);
    return std::vector{
        Estimate("drift", "rate", x[0], std::sqrt(cov(0, 0))),
        Estimate("drift", "curvature", curvature, std::sqrt(slope.dot(cov.topLeftCorner<2, 2>() * slope)))};
  };
  return family;
}

/// The same without the quadratic part, which most have not.
Family SteadyDrift(const Context& context, Seen seen) {
  Family family = NamedFamily("drift");
  family.amplitudes = {AmplitudeOf("drift", "rate")};
  const Eigen::MatrixXd time_s = DriftSignals_s(*context).leftCols(1);
  Use(context, {BaseOf(context, 1, [time_s](int) { return time_s; }), seen}, family);
  family.parameters = [](const Eigen::VectorXd&, const Eigen::VectorXd& x, const Eigen::MatrixXd& cov) {
    return std::vector{Estimate("drift", "rate", x[0], std::sqrt(cov(0, 0))),
                       Estimate("drift", "curvature", 0.0, kNaN)};
  };
  return family;
}

Family Slip(const Common& common, const std::string& where, double factor) {
  Family family = NamedFamily("slip", where);
  family.amplitudes = {AmplitudeOf("slip", "step")};
  family.shapes = {ShapeOf("slip", "at_reading", common.series.onsets)};
  Use(common.context, {common.series.steps, Seen::kByEncoders, factor}, family);
  const SeriesAt step = [context = common.context](const Eigen::VectorXd& shape) {
    return Eigen::MatrixXd(StepSignal(*context, shape[0]));
  };
  family.at = RowsAt(common.context, step, Seen::kByEncoders, factor);
  family.parameters = [](const Eigen::VectorXd& shape, const Eigen::VectorXd& x, const Eigen::MatrixXd& cov) {
    return std::vector{Estimate("slip", "step", x[0], std::sqrt(cov(0, 0))),
                       Estimate("slip", "at_reading", std::round(shape[0]), DeviationAt(cov, 1))};
  };
  return family;
}

/// Size: mean over the set-ups. Phase: of the first one, where time began.
Parameters ToneParameters() {
  return [](const Eigen::VectorXd& shape, const Eigen::VectorXd& x, const Eigen::MatrixXd& cov) {
    const Eigen::Index setups = x.size() / 2;
    const Polar first = PolarOf(x.head<2>(), cov.topLeftCorner<2, 2>());
    double size = 0.0, variance = 0.0;
    for (Eigen::Index k = 0; k < setups; ++k) {
      const Polar own = PolarOf(x.segment<2>(2 * k), cov.block<2, 2>(2 * k, 2 * k));
      size += own.size / static_cast<double>(setups);
      variance += std::pow(own.u_size / static_cast<double>(setups), 2);
    }
    return std::vector{Estimate("tone", "amplitude", size, std::sqrt(variance)),
                       Estimate("tone", "frequency", shape[0], DeviationAt(cov, x.size())),
                       Estimate("tone", "phase", first.phase_rad, first.u_phase_rad)};
  };
}

Family ToneFamily(const Common& common, Seen seen) {
  const Context& context = common.context;
  Family family = NamedFamily("tone");
  family.amplitudes.assign(static_cast<std::size_t>(common.series.tones->series(0).cols()),
                           AmplitudeOf("tone", "amplitude"));
  Shape frequency = ShapeOf("tone", "frequency", common.series.frequencies_Hz);
  frequency.lower = 0.5 * common.series.frequencies_Hz.front();
  frequency.upper = 1.1 * common.series.frequencies_Hz.back();
  family.shapes = {frequency};
  Use(context, {common.series.tones, seen}, family);
  family.at = RowsAt(
      context, [series = common.series](const Eigen::VectorXd& f_Hz) { return series.ToneAt(f_Hz[0]); }, seen);
  family.parameters = ToneParameters();
  return family;
}

}  // namespace

void AddTime(const Common& common, std::vector<Family>& families) {
  for (const Seen seen : Ways(*common.context)) {
    families.push_back(SteadyDrift(common.context, seen));
    families.push_back(Drift(common.context, seen));
    if (common.series.tones) families.push_back(ToneFamily(common, seen));
  }
  families.push_back(Slip(common, "table", 1.0));
  families.push_back(Slip(common, "hob", -common.context->train.Ratio()));
}

}  // namespace twinbench::diagnose::hob
