#include <algorithm>
#include <cmath>

#include "twin/core/units.h"
#include "twin/diagnose/turntable/named_parts.h"

namespace twinbench::diagnose::turntable {
namespace {

using units::arcsec;

/// A further turn of the crosshair: x' = x + y' angle, y' = y - x' angle.
Family Roll(const SignalContext& c) {
  Eigen::MatrixXd turned_rad(c.Readings(), kAxes);
  turned_rad << c.shown_rad.col(kY), -c.shown_rad.col(kX);
  return Linear("autocollimator_roll", "", "angle", AsRows(turned_rad));
}

/// As a lens distorts, or each axis for itself.
Family Nonlinearity(const Context& context) {
  Family family = Linear("autocollimator_nonlinearity", "", "at_edge", {});
  family.grid = 2;
  family.columns = [context](int g) {
    return Eigen::MatrixXd(AsRows(CubicSignals(context->shown_rad, context->range_rad, g == 0)));
  };
  return family;
}

/// Periods from one to another, half a cycle between the ends of the range from one to the next.
std::vector<double> Periods_rad(double range_rad, double longest_rad, double shortest_rad) {
  constexpr int kMost = 1500;
  const double first = 1.0 / longest_rad, last = 1.0 / shortest_rad;
  const int count = std::clamp(static_cast<int>(std::ceil((last - first) * 2.0 * range_rad)) + 1, 2, kMost);
  std::vector<double> periods_rad;
  for (int k = 0; k < count; ++k) periods_rad.push_back(1.0 / (first + k * (last - first) / (count - 1)));
  return periods_rad;
}

Family Periodic(const Context& context, int axis, const std::vector<double>& periods_rad) {
  Family family = Shaped("autocollimator_periodic", axis, WaveAmplitudes("autocollimator_periodic"),
                         ShapeOf("autocollimator_periodic", "period", periods_rad),
                         [context, axis](const Eigen::VectorXd& period_rad) {
                           return Wave(2.0 * units::kPi / period_rad[0] * context->shown_rad.col(axis));
                         });
  ReportWave("autocollimator_periodic", "period", family);
  return family;
}

/// The stated pixels, within a hundredth, and any other period that the scatter of the readings does not wash out.
void AddPeriodic(const Context& context, int axis, double sigma_rad, std::vector<Family>& families) {
  constexpr double kShortest_rad = 0.6 * arcsec, kWashedOut = 3.0;  // in sigma
  const Eigen::VectorXd shown_rad = context->shown_rad.col(axis);
  const double range_rad = shown_rad.maxCoeff() - shown_rad.minCoeff();
  const double shortest_rad = std::max(kShortest_rad, kWashedOut * sigma_rad), longest_rad = range_rad / 1.5;
  if (context->pixel_rad > shortest_rad && context->pixel_rad < longest_rad) {
    families.push_back(
        Periodic(context, axis, Periods_rad(range_rad, 1.01 * context->pixel_rad, 0.99 * context->pixel_rad)));
  }
  if (longest_rad > 1.2 * shortest_rad)
    families.push_back(Periodic(context, axis, Periods_rad(range_rad, longest_rad, shortest_rad)));
}

}  // namespace

void AddInstrument(const Context& context, double sigma_rad, std::vector<Family>& families) {
  families.push_back(Roll(*context));
  families.push_back(Linear("autocollimator_scale", "", "gain_error", AsRows(context->shown_rad)));
  families.push_back(Nonlinearity(context));
  for (const int axis : {kX, kY}) AddPeriodic(context, axis, sigma_rad, families);
  families.push_back(Linear("mirror_flatness", "", "sag", OnAxis(FlatnessSignal_per_m(*context), kX)));
}

}  // namespace twinbench::diagnose::turntable
