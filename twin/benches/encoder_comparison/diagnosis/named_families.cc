#include <algorithm>
#include <cmath>

#include "twin/benches/encoder_comparison/diagnosis/family_parts.h"
#include "twin/benches/encoder_comparison/format.h"
#include "twin/core/linear_algebra.h"
#include "twin/core/units.h"
#include "twin/diagnose/engine/candidates.h"
#include "twin/diagnose/engine/wave_series.h"
#include "twin/diagnose/products.h"
#include "twin/model/signals.h"

namespace twinbench::diagnose::encoder {
namespace {

using model::Wave;

/// How a cause shows: in the device's angle, or with the other sign in the reference's.
Showing Shown(const std::string& effect, double sign = 1.0) {
  return {effect, "", Eigen::MatrixXd::Constant(1, 1, sign)};
}

/// Waves of `orders`, each `factor` times a turn, by an angle.
void AddOrders(Candidates& named, const Showing& showing, const Eigen::VectorXd& angle_rad,
               const std::vector<int>& orders, const std::string& order, double factor = 1.0) {
  if (orders.empty()) return;
  const WaveSeries waves{factor * angle_rad, 0.0, 1.0, orders};
  named.AddOrders(showing, BaseOf(waves, 1, {}), order, {orders.begin(), orders.end()});
}

/// True if the device was turned on the shaft between set-ups: only then is its angle not the reference's.
bool WasTurned(const SignalContext& c) {
  const Eigen::VectorXd offset_rad = c.device_rad - c.reference_rad;
  return offset_rad.maxCoeff() - offset_rad.minCoeff() > 1.0 * units::deg;
}

void AddPeriodic(const SignalContext& c, Candidates& named) {
  const int least = LeastOrder(c);
  if (least <= 1) AddOrders(named, Shown("eccentricity"), c.device_rad, {1}, "");
  if (least <= 2) AddOrders(named, Shown("ellipticity"), c.device_rad, {2}, "");
  AddOrders(named, Shown("periodic"), c.device_rad, WholeOrders(c, 3), "order");
  if (c.device.teeth > 0)
    AddOrders(named, Shown("gear_mesh"), c.device_rad, {c.device.teeth}, "teeth");
  if (c.device.lines > 0)
    AddOrders(named, Shown("interpolation"), c.device_rad, std::vector{1, 2, 3, 4}, "order",
              c.device.lines);
  if (WasTurned(c))
    AddOrders(named, Shown("reference_fault", -1.0), c.reference_rad, WholeOrders(c, 1), "order");
}

/// Twice per period, half the fault; its phase says which fault it is, if the zero of the signals is known. If it
/// is not, the fault says where it is.
/// @param sine  The fault shows as sine of twice the phase, otherwise as cosine.
void AddTwicePerPeriod(const SignalContext& c, const std::string& effect, const std::string& parameter, bool sine,
                       Candidates& named) {
  const double periods = c.device.signal_periods;
  const Eigen::MatrixXd wave = 0.5 * Wave(2.0 * SignalPhase_rad(c)) / periods;
  if (c.device.signal_zero_known) {
    named.Add(Shown(effect), {parameter}, wave.col(sine ? 1 : 0));
    return;
  }
  Family& family = named.Add(Shown(effect), {parameter, parameter}, wave);
  const double behind_rad = sine ? 0.5 * units::kPi : 0.0;
  family.parameters = [catalogue = named.catalogue(), effect, parameter, periods, behind_rad](
                          const Eigen::VectorXd&, const Eigen::VectorXd& x, const Eigen::MatrixXd& cov) {
    const Polar polar = PolarOf(x, cov);
    // size cos(2 p + phase) with p from the stated zero is the fault at p from its own.
    const double zero_rad = std::remainder(-polar.phase_rad - behind_rad, 2.0 * units::kPi) / (2.0 * periods);
    return std::vector{catalogue.Estimate(effect, parameter, polar.size, polar.u_size),
                       catalogue.Estimate(effect, "zero", zero_rad, polar.u_phase_rad / (2.0 * periods))};
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
/// Readings that cannot show the second of them cannot tell clipping from an error of order 4.
void AddClipping(const Context& context, double plausible_rad, Candidates& named) {
  const SignalContext& c = *context;
  constexpr int kSecondOrder = 8;
  if (LargestOrder(c) < kSecondOrder * c.device.signal_periods) return;
  const double quarter_rad = 0.5 * units::kPi;  // the error repeats so
  constexpr int kZeros = 24;                    // 3.75 deg: an eighth of a period of order 12
  constexpr double kDeepest = 0.68;
  Shape level{"level", "1", 1.0, 0.3, 0.9999, {}}, zero{"zero", "deg", units::deg, -units::kPi, units::kPi, {}};
  for (const double depth : Ratios(LeastDepth(c, plausible_rad, kDeepest), kDeepest, 16)) {
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
  family.parameters = [catalogue = named.catalogue(), periods = c.device.signal_periods](
                          const Eigen::VectorXd& shape, const Eigen::VectorXd& x, const Eigen::MatrixXd& cov) {
    std::vector estimates = {catalogue.Estimate("signal_clipping", "level", shape[0], DeviationAt(cov, x.size()))};
    if (shape.size() > 1)
      estimates.push_back(catalogue.Estimate("signal_clipping", "zero", shape[1] / periods,
                                             DeviationAt(cov, x.size() + 1) / periods));
    return estimates;
  };
}

void AddSignals(const Context& context, double plausible_rad, Candidates& named) {
  const SignalContext& c = *context;
  const int periods = c.device.signal_periods;
  if (LeastOrder(c) > periods) return;  // too little of one of their periods
  // To first order the angle errs by (y error) cos - (x error) sin, in rad of the period.
  const Eigen::MatrixXd wave = Wave(SignalPhase_rad(c)) / periods;
  named.Add(Shown("signal_offset"), {"offset_sin", "offset_cos"}, wave * Eigen::Vector2d(1.0, -1.0).asDiagonal());
  AddTwicePerPeriod(c, "amplitude_mismatch", "ratio", true, named);
  AddTwicePerPeriod(c, "quadrature_error", "angle", false, named);
  AddClipping(context, plausible_rad, named);
}

/// Of the amplitude and of the shapes that the catalogue has words for.
Parameters AsInCatalogue(const Catalogue& catalogue, const std::string& effect, const std::string& amplitude,
                         const std::vector<std::string>& shapes) {
  return [=](const Eigen::VectorXd& shape, const Eigen::VectorXd& x, const Eigen::MatrixXd& cov) {
    std::vector<ParameterEstimate> estimates = {catalogue.Estimate(effect, amplitude, x[0], std::sqrt(cov(0, 0)))};
    for (std::size_t k = 0; k < shapes.size(); ++k) {
      const auto at = static_cast<Eigen::Index>(k);
      estimates.push_back(catalogue.Estimate(effect, shapes[k], shape[at], DeviationAt(cov, x.size() + at)));
    }
    return estimates;
  };
}

/// What goes by the way since the reversals, and where it begins; stops may have been reached in their direction or
/// straight.
struct WayShapes {
  Shape way, start, approach;

  /// @param ways_rad  That are tried.
  WayShapes(const SignalContext& c, const std::string& name, const std::vector<double>& ways_rad)
      : way{name, "deg", units::deg, ways_rad.front(), ways_rad.back(), {}},
        start{"start", "1", 1.0, -1.0, 1.0, {}},
        approach{"approach", "1", 1.0, 0.0, 1.0, {}} {
    const std::vector<double> approaches = RunUp_rad(c) > 0.0 ? std::vector{0.0, 1.0} : std::vector{1.0};
    for (const double way_rad : ways_rad) {
      for (const double from : {-1.0, 0.0, 1.0}) {
        for (const double share : approaches) {
          way.value.push_back(way_rad);
          start.value.push_back(from);
          approach.value.push_back(share);
        }
      }
    }
  }
  std::vector<Shape> All() const { return {way, start, approach}; }
};

double Range(const Eigen::VectorXd& values) {
  return values.maxCoeff() - values.minCoeff();
}

/// A gap that is crossed between two readings has no way of its own: it is the width.
void AddBacklashAtOnce(const Context& context, double finest_rad, Candidates& named) {
  const double at_once_rad = 1e-3 * finest_rad, run_up_rad = RunUp_rad(*context);
  const WayShapes shapes(*context, "crossed_over", {at_once_rad});
  Family& family = named.AddOver(
      Shown("backlash"), {"width"}, {shapes.start, shapes.approach}, [=](const Eigen::VectorXd& shape) {
        return Eigen::MatrixXd(Play(*context, at_once_rad, shape[0], shape[1] * run_up_rad));
      });
  family.parameters = AsInCatalogue(named.catalogue(), "backlash", "width", {"start", "approach"});
}

/// Play with its state; a gap may be crossed over more than one reading.
void AddBacklash(const Context& context, Candidates& named) {
  const double finest_rad = FinestSpacing_rad(*context), widest_rad = 0.5 * Range(context->reference_rad);
  if (finest_rad == 0.0 && !context->Moves()) AddBacklashAtOnce(context, RunUp_rad(*context), named);
  if (!(finest_rad > 0.0) || widest_rad < finest_rad) return;
  AddBacklashAtOnce(context, finest_rad, named);
  const double run_up_rad = RunUp_rad(*context);
  const WayShapes shapes(*context, "crossed_over",
                         Ratios(0.7 * finest_rad, std::max(widest_rad, 1.4 * finest_rad), 22));
  Family& family = named.AddOver(
      Shown("backlash"), {"width"}, shapes.All(), [context, run_up_rad](const Eigen::VectorXd& shape) {
        return Eigen::MatrixXd(Play(*context, shape[0], shape[1], shape[2] * run_up_rad));
      });
  family.parameters = AsInCatalogue(named.catalogue(), "backlash", "width", {"crossed_over", "start", "approach"});
}

/// The lag in steady motion; the state at the beginning is no larger than it. One that settles between two readings
/// is none that these can tell from play.
void AddHysteresis(const Context& context, Candidates& named) {
  const double finest_rad = FinestSpacing_rad(*context), longest_rad = Range(context->reference_rad);
  if (!(finest_rad > 0.0) || longest_rad < finest_rad) return;
  const double run_up_rad = RunUp_rad(*context);
  WayShapes shapes(*context, "settles_over", Ratios(0.5 * finest_rad, std::min(longest_rad, units::turn), 20));
  Family& family = named.AddOver(
      Shown("hysteresis", -1.0), {"lag"}, shapes.All(), [context, run_up_rad](const Eigen::VectorXd& shape) {
        const Eigen::MatrixXd states = Relaxation(*context, shape[0], shape[2] * run_up_rad);
        return Eigen::MatrixXd(states * Eigen::Vector2d(1.0, shape[1]));
      });
  family.parameters = AsInCatalogue(named.catalogue(), "hysteresis", "lag", {"settles_over", "start", "approach"});
}

/// Only where stops were read again and again: else it is play, or something that goes with the speed.
void AddSettling(const Context& context, Candidates& named) {
  const Eigen::VectorXd standing_s = Standing_s(*context);
  const auto again = (standing_s.array() > 0.0).count();
  constexpr Eigen::Index kFewest = 10;
  if (context->Moves() || again < kFewest) return;
  std::vector<double> each_s;
  for (const double s : standing_s) {
    if (s > 0.0) each_s.push_back(s);
  }
  const double shortest_s = 0.3 * std::ranges::min(each_s), longest_s = 2.0 * std::ranges::max(each_s);
  Shape time_constant{"time_constant", "s", 1.0, shortest_s, longest_s, Ratios(shortest_s, longest_s, 16)};
  time_constant.is_inside = true;
  Family& family =
      named.AddOver(Shown("settling", -1.0), {"amplitude"}, {time_constant},
                    [context](const Eigen::VectorXd& s) { return Eigen::MatrixXd(Settling(*context, s[0])); });
  family.parameters = AsInCatalogue(named.catalogue(), "settling", "amplitude", {"time_constant"});
}

/// What a servo is behind by. Where a motion is a sine its acceleration is its place, which is a scale; where it does not rest
/// between its ways, what friction does is what play does, which any device may have: the readings at rest have to say so.
void AddFollowingErrors(const SignalContext& c, Candidates& named) {
  constexpr double kOwn = 0.3, kShare = 0.02;  // of its size beside place and speed; of the readings
  constexpr double kOfDrives = 0.03;           // of what any device may have
  Eigen::MatrixXd others(c.Readings(), 3);
  others << Eigen::VectorXd::Ones(c.Readings()), c.reference_rad, c.velocity_rad_s;
  const Eigen::VectorXd& a = c.acceleration_rad_s2;
  const Eigen::VectorXd own = a - others * SolveShortest(others, a);
  if (c.has_clock && own.norm() > kOwn * a.norm()) named.Add(Shown("acceleration_error", -1.0), {"coefficient"}, a);
  const Eigen::VectorXd goes = Goes(c);
  const auto fewest = static_cast<Eigen::Index>(kShare * static_cast<double>(c.Readings()));
  const auto is_often = [&](double sense) { return (goes.array() == sense).count() > fewest; };
  if (is_often(-1.0) && is_often(0.0) && is_often(1.0)) named.Add(Shown("friction", -1.0), {"lag"}, goes).prior_weight = kOfDrives;
}

void AddMotion(const Context& context, Candidates& named) {
  const SignalContext& c = *context;
  const Eigen::VectorXd sense = Senses(c).front();
  if (c.Moves()) {
    named.Add(Shown("latency", -1.0), {"delay"}, c.velocity_rad_s);
    named.Add(Shown("clock_rate", -1.0), {"ratio"}, c.velocity_rad_s.cwiseProduct(c.since_start_s));
    AddFollowingErrors(c, named);
  }
  if (sense.size() > 0 && sense.maxCoeff() > sense.minCoeff()) {
    AddBacklash(context, named);
    AddHysteresis(context, named);
  }
  AddSettling(context, named);
  named.Add(Shown("scale"), {"ratio"}, c.reference_rad);
  // In about one turn a scale that bends is like its first orders.
  const double turns = Range(c.reference_rad) / units::turn;
  if (!(c.device.turn_m > 0.0) && turns > 0.9 && turns < 1.5) return;
  Eigen::MatrixXd bent(c.Readings(), 2);
  bent << c.reference_rad, c.reference_rad.cwiseAbs2() / units::turn;
  named.AddBent(Shown("scale"), "ratio", bent);
}

/// A zero that warms up: it goes over to its final value exponentially with the time.
void AddWarmUp(const Context& context, Candidates& named) {
  const Eigen::VectorXd& since_s = context->since_start_s;
  const double first_s = since_s[0], longest_s = since_s[since_s.size() - 1] - first_s;
  if (!(longest_s > 0.0)) return;
  constexpr double kShortest = 0.01;  // of the run
  Shape warm_up{
      "warm_up", "s", 1.0, kShortest * longest_s, longest_s, Ratios(kShortest * longest_s, longest_s, 16)};
  Family& family = named.AddOver(Shown("drift"), {"rate"}, {warm_up}, [context](const Eigen::VectorXd& tau_s) {
    const Eigen::ArrayXd decay = (-context->since_start_s.array() / tau_s[0]).exp();
    return Eigen::MatrixXd(tau_s[0] * (1.0 - decay).matrix());
  });
  family.parameters = [catalogue = named.catalogue()](const Eigen::VectorXd& shape, const Eigen::VectorXd& x,
                                                      const Eigen::MatrixXd& cov) {
    return std::vector{catalogue.Estimate("drift", "rate", x[0], std::sqrt(cov(0, 0))),
                       catalogue.Estimate("drift", "curvature", 0.0, kNaN),
                       catalogue.Estimate("drift", "warm_up", shape[0], DeviationAt(cov, 1))};
  };
}

/// A zero or a scale that follows the temperature, or one that lags behind it.
void AddTemperature(const Context& context, Candidates& named) {
  if (context->above_K.size() == 0 || Range(context->above_K) == 0.0) return;
  const auto add = [&](const std::string& effect, const std::string& parameter, const Eigen::VectorXd& of) -> Family& {
    if (!context->has_clock) return named.Add(Shown(effect), {parameter}, of.cwiseProduct(context->above_K));
    return named.AddOver(Shown(effect), {parameter}, {named.catalogue().ShapeOf(effect, "lag", TemperatureLags_s())},
                         [context, of](const Eigen::VectorXd& lag_s) {
                           return Eigen::MatrixXd(of.cwiseProduct(model::Lagged(context->since_start_s, context->above_K, lag_s[0])));
                         });
  };
  add("zero_temperature", "coefficient", Eigen::VectorXd::Ones(context->Readings()));
  Family& growth = add("scale_temperature", "growth", context->reference_rad);
  constexpr double kOfAngles = 0.03;  // a turn is one at any temperature; a potentiometer's track is not
  if (!(context->device.turn_m > 0.0)) growth.prior_weight = kOfAngles;
}

/// Faults of the signals know what strength they have.
void SetSizes(double plausible_rad, Family& family) {
  if (family.effect == "signal_clipping") return;
  SetSizesByTrace(1, plausible_rad, family);
}

}  // namespace

std::vector<Family> NamedFamilies(const Context& context, const TimeSeries& series, double plausible_rad) {
  Candidates named(Catalogue(benches::encoder::Format().effects), 1);
  AddPeriodic(*context, named);
  AddSignals(context, plausible_rad, named);
  AddMotion(context, named);
  if (context->has_clock) {
    named.AddDrift(Shown("drift"), "rate", context->since_start_s);
    AddWarmUp(context, named);
  }
  AddTemperature(context, named);
  named.AddStep(Shown("slip"), "step", series);
  std::vector<Family> families = named.Take();
  for (Family& family : families) SetSizes(plausible_rad, family);
  return families;
}

}  // namespace twinbench::diagnose::encoder
