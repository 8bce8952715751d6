#include <algorithm>
#include <cmath>

#include "twin/benches/turntable_autocollimator/diagnosis/family_parts.h"
#include "twin/benches/turntable_autocollimator/format.h"
#include "twin/core/units.h"
#include "twin/model/signals.h"

namespace twinbench::diagnose::turntable {
namespace {

using units::arcsec;

const char* NameOf(int axis) {
  return kAxisNames[static_cast<std::size_t>(axis)];
}

/// A cause that has a place on either axis.
Showing OnAxis(const std::string& effect, int axis, double factor = 1.0) {
  return {effect, NameOf(axis), factor * Eigen::Vector2d::Unit(axis)};
}

/// One that has its axis by nature: what the turntable does shows in x.
Showing OfBody(const std::string& effect, double factor = 1.0) {
  return {effect, "", factor * Eigen::Vector2d::UnitX()};
}

/// One whose signature is rows already.
Showing InRows(const std::string& effect) {
  return {effect, "", {}};
}

/// A further turn of the crosshair: x' = x + y' angle, y' = y - x' angle. A lens distorts both axes by the distance
/// from the middle, or each axis for itself.
void AddInstrument(const SignalContext& c, Candidates& named) {
  Eigen::MatrixXd turned_rad(c.Readings(), kAxes);
  turned_rad << c.shown_rad.col(kY), -c.shown_rad.col(kX);
  named.Add(InRows("autocollimator_roll"), {"angle"}, AsRows(turned_rad));
  named.Add(InRows("autocollimator_scale"), {"gain_error"}, AsRows(c.shown_rad));
  for (const bool radial : {true, false})
    named.Add(InRows("autocollimator_nonlinearity"), {"at_edge"},
              AsRows(CubicSignals(c.shown_rad, c.range_rad, radial)));
  named.Add(OfBody("mirror_flatness"), {"sag"}, FlatnessSignal_per_m(c));
}

/// Periods from one to another, half a cycle between the ends of the range from one to the next.
std::vector<double> Periods_rad(double range_rad, double longest_rad, double shortest_rad) {
  constexpr int kMost = 1500;
  const double first = 1.0 / longest_rad, last = 1.0 / shortest_rad;
  const int count = std::clamp(static_cast<int>(std::ceil((last - first) * 2.0 * range_rad)) + 1, 2, kMost);
  std::vector<double> periods_rad;
  for (const double per_rad : Even(first, last, count)) periods_rad.push_back(1.0 / per_rad);
  return periods_rad;
}

void AddRipple(const Context& context, int axis, const std::vector<double>& periods_rad, Candidates& named) {
  const std::string effect = "autocollimator_periodic";
  Family& family = named.AddOver(OnAxis(effect, axis), {"amplitude", "amplitude"},
                                 {named.catalogue().ShapeOf(effect, "period", periods_rad)},
                                 [context, axis](const Eigen::VectorXd& period_rad) {
                                   return model::Wave(units::turn / period_rad[0] * context->shown_rad.col(axis));
                                 });
  family.amplitudes[1].name = "quadrature";
  family.parameters = [catalogue = named.catalogue(), effect](
                          const Eigen::VectorXd& shape, const Eigen::VectorXd& x, const Eigen::MatrixXd& cov) {
    const Polar polar = PolarOf(x, cov);
    return std::vector{catalogue.Estimate(effect, "amplitude", polar.size, polar.u_size),
                       catalogue.Estimate(effect, "period", shape[0], DeviationAt(cov, x.size())),
                       catalogue.Estimate(effect, "phase", polar.phase_rad, polar.u_phase_rad)};
  };
}

/// The stated pixels, within a hundredth, and any other period that the scatter of the readings does not wash out.
void AddRipples(const Context& context, int axis, double sigma_rad, Candidates& named) {
  constexpr double kShortest_rad = 0.6 * arcsec, kWashedOut = 3.0;  // in sigma
  const Eigen::VectorXd shown_rad = context->shown_rad.col(axis);
  const double range_rad = shown_rad.maxCoeff() - shown_rad.minCoeff(), pixel_rad = context->pixel_rad;
  const double shortest_rad = std::max(kShortest_rad, kWashedOut * sigma_rad), longest_rad = range_rad / 1.5;
  if (pixel_rad > shortest_rad && pixel_rad < longest_rad)
    AddRipple(context, axis, Periods_rad(range_rad, 1.01 * pixel_rad, 0.99 * pixel_rad), named);
  if (longest_rad > 1.2 * shortest_rad)
    AddRipple(context, axis, Periods_rad(range_rad, longest_rad, shortest_rad), named);
}

void AddTime(const Context& context, int axis, const TimeSeries& series, Candidates& named) {
  const SignalContext& c = *context;
  named.AddDrift(OnAxis("autocollimator_drift", axis), "rate", c.schedule.time_s);
  // Slower than a quarter of an hour a creep is a drift.
  Shape time_constant = named.catalogue().ShapeOf("mount_creep", "time_constant", Ratios(5.0, 900.0, 8));
  time_constant.lower = 2.0;
  named.AddOver(OnAxis("mount_creep", axis), {"amplitude"}, {time_constant},
                [context](const Eigen::VectorXd& tau_s) { return CreepSignal(*context, tau_s[0]); });
  if (c.HasTemperature()) named.Add(OnAxis("autocollimator_temperature", axis), {"coefficient"}, c.above_K);
  named.AddStep(OnAxis("slip", axis), "step", series);
  named.AddTone(OnAxis("tone", axis), series);
}

void AddSettling(const Context& context, Candidates& named) {
  const auto arrived_s = context->since_arrival_s.array();
  const double soonest_s = std::max(arrived_s.isFinite().select(arrived_s, 1e9).minCoeff(), 0.1);
  named.AddSettling(OfBody("settling"), soonest_s, [context](const Eigen::VectorXd& tau_s) -> Eigen::MatrixXd {
    return SettlingSignal(*context, tau_s[0]);
  });
}

void AddBody(const Context& context, Candidates& named) {
  named.Add(OfBody("backlash"), {"width"}, BacklashSignal(*context));
  if (context->HasDwell()) AddSettling(context, named);
}

}  // namespace

std::vector<Family> NamedFamilies(const Context& context, double sigma_rad, const TimeSeries& series) {
  Candidates named(Catalogue(benches::turntable::Format().effects), kAxes);
  AddInstrument(*context, named);
  for (const int axis : {kX, kY}) {
    AddRipples(context, axis, sigma_rad, named);
    AddTime(context, axis, series, named);
  }
  AddBody(context, named);
  return named.Take();
}

}  // namespace twinbench::diagnose::turntable
