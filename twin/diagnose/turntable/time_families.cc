#include <cmath>

#include "twin/core/units.h"
#include "twin/diagnose/turntable/named_parts.h"

namespace twinbench::diagnose::turntable {
namespace {

/// Without its quadratic part.
Family SteadyDrift(const SignalContext& c, int axis) {
  return Linear("autocollimator_drift", kAxisNames[static_cast<std::size_t>(axis)], "rate",
                OnAxis(DriftSignals_s(c).leftCols(1), axis));
}

/// Amplitudes: the rate, and the rate times the share of the quadratic part.
Family Drift(const SignalContext& c, int axis) {
  Family family = Linear("autocollimator_drift", kAxisNames[static_cast<std::size_t>(axis)], "rate",
                         OnAxis(DriftSignals_s(c), axis));
  family.amplitudes.push_back(family.amplitudes[0]);
  family.amplitudes[1].name = "bend";
  family.parameters = [](const Eigen::VectorXd&, const Eigen::VectorXd& x, const Eigen::MatrixXd& cov) {
    const double curvature = x[1] / x[0];
    const Eigen::Vector2d slope(-curvature / x[0], 1.0 / x[0]);
    return std::vector{Estimate("autocollimator_drift", "rate", x[0], std::sqrt(cov(0, 0))),
                       Estimate("autocollimator_drift", "curvature", curvature, std::sqrt(slope.dot(cov * slope)))};
  };
  return family;
}

/// Slower than a quarter of an hour a creep is a drift.
Family Creep(const Context& context, int axis) {
  Shape time_constant = ShapeOf("mount_creep", "time_constant", Ratios(5.0, 900.0, 8));
  time_constant.lower = 2.0;
  time_constant.upper = 900.0;
  return Shaped("mount_creep", axis, {AmplitudeOf("mount_creep", "amplitude")}, time_constant,
                [context](const Eigen::VectorXd& tau_s) { return CreepSignal(*context, tau_s[0]); });
}

void AddSlips(const TimeSeries& series, std::vector<Family>& families) {
  if (!series.steps) return;
  for (const int axis : {kX, kY}) {
    Family family = Linear("slip", kAxisNames[static_cast<std::size_t>(axis)], "step", {});
    family.shapes = {ShapeOf("slip", "at_reading", series.onsets)};
    family.grid = series.steps->grid;
    family.columns = nullptr;
    family.base = series.steps;
    family.map = MapOfAxis(axis, 1);
    families.push_back(std::move(family));
  }
}

void AddTones(const TimeSeries& series, std::vector<Family>& families) {
  if (!series.tones) return;
  const Signal tone = [series](const Eigen::VectorXd& frequency_Hz) { return series.ToneAt(frequency_Hz[0]); };
  for (const int axis : {kX, kY}) {
    Family family =
        Shaped("tone", axis, WaveAmplitudes("tone"), ShapeOf("tone", "frequency", series.frequencies_Hz), tone);
    family.base = series.tones;
    family.map = MapOfAxis(axis, 2);
    ReportWave("tone", "frequency", family);
    families.push_back(std::move(family));
  }
}

}  // namespace

void AddTime(const Context& context, const TimeSeries& series, std::vector<Family>& families) {
  for (const int axis : {kX, kY}) {
    const char* const where = kAxisNames[static_cast<std::size_t>(axis)];
    families.push_back(SteadyDrift(*context, axis));
    families.push_back(Drift(*context, axis));
    families.push_back(Creep(context, axis));
    if (context->HasTemperature())
      families.push_back(
          Linear("autocollimator_temperature", where, "coefficient", OnAxis(context->above_K, axis)));
  }
  AddSlips(series, families);
  AddTones(series, families);
}

}  // namespace twinbench::diagnose::turntable
