#include <cmath>
#include <set>

#include "twin/benches/encoder_comparison/diagnosis/family_parts.h"
#include "twin/benches/encoder_comparison/format.h"
#include "twin/core/units.h"
#include "twin/diagnose/engine/candidates.h"
#include "twin/model/signals.h"
#include "twin/model/wave_grid.h"

namespace twinbench::diagnose::encoder {
namespace {

using model::Wave;

std::vector<double> WholeOrders(int first, int last) {
  std::vector<double> orders;
  for (int k = first; k <= last; ++k) orders.push_back(k);
  return orders;
}

/// How a cause shows: in the device's angle, or with the other sign in the reference's.
Showing Shown(const std::string& effect, double sign = 1.0) {
  return {effect, "", Eigen::MatrixXd::Constant(1, 1, sign)};
}

/// Waves of `orders`, each `factor` times a turn, by an angle.
void AddOrders(Candidates& named, const Showing& showing, const Eigen::VectorXd& angle_rad,
               const std::vector<double>& orders, const std::string& order, double factor = 1.0) {
  const auto count = static_cast<int>(std::ssize(orders));
  if (count == 0) return;
  const auto waves = std::make_shared<const model::WaveGrid>(factor * angle_rad, orders.front(), 1.0, count);
  named.AddOrders(showing, named.BaseOf(count, [waves](int g) { return waves->At(g); }), order, orders);
}

/// True if the device was turned on the shaft between set-ups: only then is its angle not the reference's.
bool WasTurned(const SignalContext& c) {
  const Eigen::VectorXd offset_rad = c.device_rad - c.reference_rad;
  return offset_rad.maxCoeff() - offset_rad.minCoeff() > 1.0 * units::deg;
}

void AddPeriodic(const SignalContext& c, Candidates& named) {
  const int last = LargestOrder(c);
  AddOrders(named, Shown("eccentricity"), c.device_rad, {1.0}, "");
  AddOrders(named, Shown("ellipticity"), c.device_rad, {2.0}, "");
  AddOrders(named, Shown("periodic"), c.device_rad, WholeOrders(3, last), "order");
  if (c.device.teeth > 0)
    AddOrders(named, Shown("gear_mesh"), c.device_rad, {static_cast<double>(c.device.teeth)}, "teeth");
  if (c.device.lines > 0)
    AddOrders(named, Shown("interpolation"), c.device_rad, WholeOrders(1, 4), "order", c.device.lines);
  if (WasTurned(c))
    AddOrders(named, Shown("reference_fault", -1.0), c.reference_rad, WholeOrders(1, last), "order");
}

/// Twice per period, half the fault; its phase says which fault it is, if the zero of the signals is known.
/// @param sine  The fault shows as sine of twice the phase, otherwise as cosine.
void AddTwicePerPeriod(const SignalContext& c, const std::string& effect, const std::string& parameter, bool sine,
                       Candidates& named) {
  const Eigen::MatrixXd wave = 0.5 * Wave(2.0 * SignalPhase_rad(c)) / c.device.signal_periods;
  if (c.device.signal_zero_known) {
    named.Add(Shown(effect), {parameter}, wave.col(sine ? 1 : 0));
    return;
  }
  Family& family = named.Add(Shown(effect), {parameter, parameter}, wave);
  family.parameters = [catalogue = named.catalogue(), effect, parameter](
                          const Eigen::VectorXd&, const Eigen::VectorXd& x, const Eigen::MatrixXd& cov) {
    const Polar polar = PolarOf(x, cov);
    return std::vector{catalogue.Estimate(effect, parameter, polar.size, polar.u_size)};
  };
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
void AddClipping(const Context& context, double plausible_rad, Candidates& named) {
  const SignalContext& c = *context;
  const double quarter_rad = 0.5 * units::kPi;  // the error repeats so
  constexpr int kZeros = 24;                    // 3.75 deg: an eighth of a period of order 12
  constexpr double kDeepest = 0.25;
  Shape level{"level", "1", 1.0, 0.72, 0.9999, {}}, zero{"zero", "deg", units::deg, -units::kPi, units::kPi, {}};
  for (const double depth : Ratios(LeastDepth(c, plausible_rad, kDeepest), kDeepest, 12)) {
    for (int k = 0; k < (c.device.signal_zero_known ? 1 : kZeros); ++k) {
      level.value.push_back(1.0 - depth);
      zero.value.push_back(k * quarter_rad / kZeros);
    }
  }
  std::vector<Shape> shapes = {level, zero};
  if (c.device.signal_zero_known) shapes.pop_back();
  Family& family = named.AddOver(Shown("signal_clipping"), {}, shapes, [context](const Eigen::VectorXd& shape) {
    const double zero_rad = shape.size() > 1 ? shape[1] : 0.0;
    const Eigen::VectorXd phase = SignalPhase_rad(*context).array() - zero_rad;
    return Eigen::MatrixXd(ClippingError_rad(phase, shape[0]) / context->device.signal_periods);
  });
  // One where the signal is as large as the level says; a little freedom for cut-offs that are not quite sharp.
  family.amplitudes = {{"strength", "1", 1.0, 1.0, 0.3, 3.0}};
  family.parameters = [catalogue = named.catalogue()](const Eigen::VectorXd& shape, const Eigen::VectorXd& x,
                                                      const Eigen::MatrixXd& cov) {
    return std::vector{catalogue.Estimate("signal_clipping", "level", shape[0], DeviationAt(cov, x.size()))};
  };
}

void AddSignals(const Context& context, double plausible_rad, Candidates& named) {
  const SignalContext& c = *context;
  // To first order the angle errs by (y error) cos - (x error) sin, in rad of the period.
  const Eigen::MatrixXd wave = Wave(SignalPhase_rad(c)) / c.device.signal_periods;
  named.Add(Shown("signal_offset"), {"offset_sin", "offset_cos"}, wave * Eigen::Vector2d(1.0, -1.0).asDiagonal());
  AddTwicePerPeriod(c, "amplitude_mismatch", "ratio", true, named);
  AddTwicePerPeriod(c, "quadrature_error", "angle", false, named);
  AddClipping(context, plausible_rad, named);
}

/// Of the first amplitude and the first shape, if the catalogue has a word for it; the others are means to an end.
Parameters FirstOf(const Catalogue& catalogue, const std::string& effect, const std::string& amplitude,
                   const std::string& shape_name = "") {
  return [=](const Eigen::VectorXd& shape, const Eigen::VectorXd& x, const Eigen::MatrixXd& cov) {
    std::vector<ParameterEstimate> estimates = {catalogue.Estimate(effect, amplitude, x[0], std::sqrt(cov(0, 0)))};
    if (!shape_name.empty())
      estimates.push_back(catalogue.Estimate(effect, shape_name, shape[0], DeviationAt(cov, x.size())));
    return estimates;
  };
}

/// To first order half the gap behind the motion, with the sense remembered in one of several ways.
void AddBacklash(const SignalContext& c, Candidates& named) {
  const std::vector<Eigen::VectorXd> senses = Senses(c);
  const auto count = static_cast<int>(std::ssize(senses));
  Family& family = named.AddShared(Shown("backlash", -0.5), {"width"}, named.BaseOf(count, [senses](int g) {
    return Eigen::MatrixXd(senses[static_cast<std::size_t>(g)]);
  }));
  family.shapes = {{"memory", "1", 1.0, 0.0, 2.0, Even(0.0, count - 1.0, count)}};
  family.parameters = FirstOf(named.catalogue(), "backlash", "width");
}

/// The lag in steady motion, and what is left of an unknown state at the beginning: that is no larger than the lag.
void AddHysteresis(const Context& context, Candidates& named) {
  const double run_up_rad = RunUp_rad(*context);
  Shape settles{"settles_over", "deg", units::deg, 2.0 * units::deg, 360.0 * units::deg, {}};
  Shape run_up{"run_up", "deg", units::deg, 0.0, std::max(run_up_rad, 1e-9), {}};
  for (const double way_rad : Ratios(3.0 * units::deg, 180.0 * units::deg, 14)) {
    for (const double approach_rad : std::set<double>{0.0, run_up_rad}) {
      settles.value.push_back(way_rad);
      run_up.value.push_back(approach_rad);
    }
  }
  Family& family =
      named.AddOver(Shown("hysteresis", -1.0), {"lag", "lag"}, {settles, run_up},
                    [context](const Eigen::VectorXd& shape) { return Relaxation(*context, shape[0], shape[1]); });
  family.amplitudes[1].name = "start";
  family.parameters = FirstOf(named.catalogue(), "hysteresis", "lag", "settles_over");
}

void AddMotion(const Context& context, Candidates& named) {
  const SignalContext& c = *context;
  const Eigen::VectorXd sense = Senses(c).front();
  if (c.Moves()) named.Add(Shown("latency", -1.0), {"delay"}, c.velocity_rad_s);
  if (sense.size() > 0 && sense.maxCoeff() > sense.minCoeff()) {
    AddBacklash(c, named);
    AddHysteresis(context, named);
  }
  named.Add(Shown("scale"), {"ratio"}, c.reference_rad);
}

/// Faults of the signals know what strength they have; the states of a hysteresis are as large as its lag.
void SetSizes(double plausible_rad, Family& family) {
  if (family.effect == "signal_clipping") return;
  SetSizesByTrace(1, plausible_rad, family);
  if (family.effect != "hysteresis") return;
  for (Amplitude& amplitude : family.amplitudes) amplitude.prior_sd = plausible_rad;
}

}  // namespace

std::vector<Family> NamedFamilies(const Context& context, const TimeSeries& series, double plausible_rad) {
  Candidates named(Catalogue(benches::encoder::Format().effects), 1);
  AddPeriodic(*context, named);
  AddSignals(context, plausible_rad, named);
  AddMotion(context, named);
  named.AddDrift(Shown("drift"), "rate", context->since_start_s);
  named.AddStep(Shown("slip"), "step", series);
  std::vector<Family> families = named.Take();
  for (Family& family : families) SetSizes(plausible_rad, family);
  return families;
}

}  // namespace twinbench::diagnose::encoder
