#include "twin/benches/circular_motion/estimators/circle_model.h"

#include <algorithm>

#include "twin/benches/circular_motion/columns.h"

namespace twinbench::separate::circular {
namespace {

using Eigen::Vector2d;

/// @param quarters  0: x goes with the cosine, 1: y with the sine.
/// @param square_s2  Of the lag; apart from it where it is an unknown of its own.
AxisMotion MotionOf(const CirclePoint& p, const CircleConstants& known, double lag_s, double square_s2, double commanded_rad, int quarters) {
  const double lag = p.rate_rad_s * lag_s;
  const double amplitude_m = known.is_delay ? p.radius_m : p.radius_m / std::sqrt(1.0 + p.rate_rad_s * p.rate_rad_s * square_s2);
  const double angle_rad = commanded_rad - (known.is_delay ? lag : std::atan(lag)) - quarters * 0.5 * units::kPi;
  // Counted along the motion the axis turns at 0, pi, 2 pi; in the first half turn it goes down.
  const double along_rad = std::remainder(p.direction * angle_rad, units::turn);
  const bool down = along_rad >= 0.0;
  const double since_rad = down ? along_rad : along_rad + units::kPi;
  AxisMotion axis{amplitude_m * std::cos(angle_rad), down ? -1.0 : 1.0, amplitude_m * (1.0 - std::cos(since_rad)),
                  p.rate_rad_s == 0.0 ? -1.0 : since_rad / std::abs(p.rate_rad_s)};
  const double wave_rad = units::turn * axis.at_m / known.pitch_m;
  axis.wave_sine = std::sin(wave_rad);
  axis.wave_cosine = std::cos(wave_rad);
  axis.spike_times = axis.since_turn_s / known.spike_time_s;
  axis.spike_decay = std::exp(1.0 - axis.spike_times);
  return axis;
}

double AxisError_m(const CircleErrors& e, const CircleConstants& known, std::size_t k, const AxisMotion& axis,
                   double other_m, double above_K) {
  const double u = other_m / known.span_m;
  const double scale = e.scale[k] + (k == 0 ? 0.5 : -0.5) * e.scale_mismatch;
  double error_m = (scale + e.expansion_per_K[k] * above_K) * axis.at_m + e.drift_m_per_K[k] * above_K;
  error_m += e.bow_m[k] * (1.5 * u * u - 0.5) + e.s_shape_m[k] * (2.5 * u * u - 1.5) * u;
  error_m += e.cyclic_sine_m[k] * axis.wave_sine + e.cyclic_cosine_m[k] * axis.wave_cosine;
  const double width_m = std::abs(e.backlash_m[k]);
  const double taken_up_m = std::copysign(std::min(axis.since_turn_m, width_m), e.backlash_m[k]);
  error_m += axis.sense * (0.5 * e.backlash_m[k] - taken_up_m);
  if (axis.since_turn_s < 0.0) return error_m;
  return error_m - axis.sense * e.spike_m[k] * axis.spike_times * axis.spike_decay;
}

/// Of the spindle from the commanded centre, so much before the reading.
Vector2d Position_m(const CirclePoint& p, const CircleErrors& e, const CircleConstants& known, double before_s,
                    CircleMemo::Axes& memo) {
  const double commanded_rad = p.commanded_rad - p.rate_rad_s * before_s;
  const auto motion = [&](std::size_t k) -> const AxisMotion& {
    const double lag_s = e.lag_s[k] + e.lag_mean_s + (k == 0 ? 0.5 : -0.5) * e.lag_mismatch_s;
    const double square_s2 = lag_s * lag_s - e.lag_mean_s * e.lag_mean_s + e.lag_mean_square_s2;
    return memo[k].At({lag_s, square_s2, before_s},
                      [&] { return MotionOf(p, known, lag_s, square_s2, commanded_rad, static_cast<int>(k)); });
  };
  const AxisMotion &x = motion(0), &y = motion(1);
  return {x.at_m + AxisError_m(e, known, 0, x, y.at_m, p.above_K) - e.squareness_rad * y.at_m,
          y.at_m + AxisError_m(e, known, 1, y, x.at_m, p.above_K)};
}

double Wave(const AxisPair& cosine_sine, double angle_rad) {
  if (cosine_sine == AxisPair{}) return 0.0;  // most are, and each costs two functions of an angle
  return cosine_sine[0] * std::cos(angle_rad) + cosine_sine[1] * std::sin(angle_rad);
}

double BallForm_m(const CircleErrors& e, double azimuth_rad) {
  return Wave(e.ball2_m, 2.0 * azimuth_rad) + Wave(e.ball3_m, 3.0 * azimuth_rad);
}

double ScaleError_rad(const CircleErrors& e, double azimuth_rad) {
  return Wave(e.eccentricity_rad, azimuth_rad) + Wave(e.ellipticity_rad, 2.0 * azimuth_rad);
}

double Azimuth_rad(const Vector2d& v_m) {
  return std::atan2(v_m.y(), v_m.x());
}

TiltTurns TurnsOf(const CircleConstants& known) {
  return {std::cos(known.tilt_rad[0]), std::sin(known.tilt_rad[0]), std::cos(known.tilt_rad[1]), std::sin(known.tilt_rad[1])};
}

/// As the encoder sees it whose axis is tilted: azimuth of [Ry Rx]^T (v, height).
double SeenAzimuth_rad(const Vector2d& v_m, const CircleConstants& known, const TiltTurns& tilt) {
  const auto& [cx, sx, cy, sy] = tilt;
  const double along_m = sy * v_m.x() + cy * known.height_m;  // after Ry: (cy x - sy h, y, sy x + cy h)
  return std::atan2(cx * v_m.y() + sx * along_m, cy * v_m.x() - sy * known.height_m);
}

/// Of the bar where it shows zero.
double BarLength_m(const CirclePoint& p, const CircleErrors& e, const CircleMounting& m) {
  return (p.radius_m + m.length_m) * (1.0 + e.bar_expansion_per_K * p.above_K);
}

Vector2d BarShown_m(const CirclePoint& p, const CircleErrors& e, const CircleMounting& m,
                    const CircleConstants& known, CircleMemo& memo) {
  const Vector2d offset_m(m.offset_m[0], m.offset_m[1]);
  const Vector2d v_m = offset_m + Position_m(p, e, known, known.bar_latency_s, memo.when_bar_is_read);
  const double ball_rad = Azimuth_rad(v_m);
  const double form_m = memo.ball_form_m.At({ball_rad, e.ball2_m[0], e.ball2_m[1], e.ball3_m[0], e.ball3_m[1]},
                                            [&] { return BallForm_m(e, ball_rad); });
  const double longer_m = std::hypot(v_m.norm(), known.height_m) - BarLength_m(p, e, m) + form_m;
  const double radial_m = longer_m * (1.0 + e.bar_gain + e.bar_cubic_per_m2 * longer_m * longer_m);
  if (!p.has_angle) return {radial_m, 0.0};
  const double azimuth_rad =
      SeenAzimuth_rad(offset_m + Position_m(p, e, known, e.encoder_latency_s, memo.when_encoder_is_read), known,
                      memo.tilt.At(known.tilt_rad, [&] { return TurnsOf(known); }));
  const double scale_rad = memo.scale_error_rad.At(
      {azimuth_rad, e.eccentricity_rad[0], e.eccentricity_rad[1], e.ellipticity_rad[0], e.ellipticity_rad[1]},
      [&] { return ScaleError_rad(e, azimuth_rad); });
  const double shown_rad = azimuth_rad + scale_rad + m.rotation_rad;
  return {radial_m, p.radius_m * std::remainder(shown_rad - p.commanded_rad, units::turn)};
}

Vector2d Turned(const Vector2d& v, const Turn& by) {
  return {by.cosine * v.x() - by.sine * v.y(), by.sine * v.x() + by.cosine * v.y()};
}
Vector2d Turned(const Vector2d& v, double angle_rad) {
  return Turned(v, Turn(angle_rad));
}

/// Of the plate's two axes, from where the spindle is and back.
Vector2d OnPlate_m(const Vector2d& at_m, const CircleConstants& known) {
  return {(1.0 + known.grid_scale[0]) * at_m.x() - known.grid_shear_rad * at_m.y(),
          (1.0 + known.grid_scale[1]) * at_m.y()};
}
Vector2d FromPlate_m(const Vector2d& plate_m, const CircleConstants& known) {
  const double y_m = plate_m.y() / (1.0 + known.grid_scale[1]);
  return {(plate_m.x() + known.grid_shear_rad * y_m) / (1.0 + known.grid_scale[0]), y_m};
}

/// Subdivisional error of a place on the grid.
Vector2d Subdivision_m(const Vector2d& place_m, const CircleConstants& known) {
  if (known.grid_sde_m == 0.0) return {0.0, 0.0};
  return known.grid_sde_m * (units::turn / known.grid_period_m * place_m.array()).sin().matrix();
}

Vector2d GridShown_m(const CirclePoint& p, const CircleErrors& e, const CircleMounting& m,
                     const CircleConstants& known, CircleMemo& memo) {
  const Vector2d offset_m(m.offset_m[0], m.offset_m[1]);
  const Turn of_grid = memo.of_grid.At({m.rotation_rad}, [&m] { return Turn(m.rotation_rad); });
  const Turn back = memo.back.At({p.commanded_rad}, [&p] { return Turn(-p.commanded_rad); });
  Vector2d shown_m = Turned(OnPlate_m(Position_m(p, e, known, 0.0, memo.when_bar_is_read), known), of_grid) + offset_m;
  shown_m += Subdivision_m(shown_m, known);
  return Turned(shown_m - p.radius_m * Vector2d(back.cosine, -back.sine), back);
}

/// The transducer bends by how much longer the bar is, not by what it shows.
double Longer_m(const CirclePoint& p, const CircleErrors& e) {
  constexpr int kNewtonSteps = 6;
  const double gain = 1.0 + e.bar_gain, cubic = e.bar_cubic_per_m2;
  double longer_m = p.radial_m / gain;
  for (int k = 0; k < kNewtonSteps; ++k) {
    const double square_m2 = longer_m * longer_m;
    longer_m -= (longer_m * (gain + cubic * square_m2) - p.radial_m) / (gain + 3.0 * cubic * square_m2);
  }
  return longer_m;
}

/// How the spindle came from where it was so much before to where it is, by the errors that were found: most of it is the commanded circle.
Vector2d Since_m(const CirclePoint& p, const CircleErrors& e, const CircleConstants& known, double before_s) {
  if (before_s == 0.0 || p.rate_rad_s == 0.0) return {0.0, 0.0};
  CircleMemo::Axes now, before;
  return Position_m(p, e, known, 0.0, now) - Position_m(p, e, known, before_s, before);
}

/// Along the radius, at the angle commanded when the bar was read: there the bar's length goes by the angle between the radius and itself.
/// The length counts as it was set.
Vector2d FromRadialBar_m(const CirclePoint& p, const CircleErrors& e, const CircleMounting& m, const CircleConstants& known) {
  const double then_rad = p.commanded_rad - p.rate_rad_s * known.bar_latency_s;
  const double length_m = BarLength_m(p, e, {}) + Longer_m(p, e) - BallForm_m(e, then_rad);
  const Vector2d offset_m = Turned({m.offset_m[0], m.offset_m[1]}, -then_rad);
  const double flat_m = std::sqrt(length_m * length_m - known.height_m * known.height_m - offset_m.y() * offset_m.y());
  return Turned({flat_m - offset_m.x(), 0.0}, then_rad) + Since_m(p, e, known, known.bar_latency_s) - p.Commanded_m();
}

/// The encoder errs, and is askew, by where the bar is, not by what is shown.
double TrueAzimuth_rad(const CirclePoint& p, const CircleErrors& e, const CircleConstants& known, double shown_rad) {
  constexpr int kIterations = 6;  // each leaves a tenth at most, of encoders that err by degrees
  const TiltTurns tilt = TurnsOf(known);
  double seen_rad = shown_rad;
  for (int k = 0; k < kIterations; ++k) seen_rad = shown_rad - ScaleError_rad(e, seen_rad);
  double azimuth_rad = seen_rad;
  for (int k = 0; k < kIterations; ++k)
    azimuth_rad -= std::remainder(SeenAzimuth_rad(Turned({p.radius_m, 0.0}, azimuth_rad), known, tilt) - seen_rad, units::turn);
  return azimuth_rad;
}

/// How far the bar turned from when the encoder was read to when the bar was. Both are of the machine as it errs there: within a second of
/// latency a circle is another one by micrometres.
double BetweenReadings_rad(const CirclePoint& p, const CircleErrors& e, const CircleMounting& m, const CircleConstants& known) {
  if (e.encoder_latency_s == known.bar_latency_s) return 0.0;
  const Vector2d offset_m(m.offset_m[0], m.offset_m[1]);
  const auto azimuth_rad = [&](double before_s) {
    CircleMemo::Axes memo;
    return Azimuth_rad(offset_m + Position_m(p, e, known, before_s, memo));
  };
  const double turned_rad = p.rate_rad_s * (e.encoder_latency_s - known.bar_latency_s);
  return turned_rad + std::remainder(azimuth_rad(known.bar_latency_s) - azimuth_rad(e.encoder_latency_s) - turned_rad, units::turn);
}

Vector2d FromBar_m(const CirclePoint& p, const CircleErrors& e, const CircleMounting& m,
                   const CircleConstants& known) {
  const double longer_m = Longer_m(p, e);
  const double shown_rad = p.commanded_rad + p.tangential_m / p.radius_m - m.rotation_rad;
  const double azimuth_rad =
      TrueAzimuth_rad(p, e, known, shown_rad) + BetweenReadings_rad(p, e, m, known);  // where it was when the bar was read
  const double length_m = BarLength_m(p, e, m) + longer_m - BallForm_m(e, azimuth_rad);
  const double flat_m = std::sqrt(length_m * length_m - known.height_m * known.height_m);
  const Vector2d then_m = Turned({flat_m, 0.0}, azimuth_rad) - Vector2d(m.offset_m[0], m.offset_m[1]);
  return then_m + Since_m(p, e, known, known.bar_latency_s) - p.Commanded_m();
}

Vector2d FromGrid_m(const CirclePoint& p, const CircleMounting& m, const CircleConstants& known) {
  const Vector2d shown_m = p.Commanded_m() + Turned({p.radial_m, p.tangential_m}, p.commanded_rad);
  const Vector2d first_m = shown_m - Subdivision_m(shown_m, known);
  const Vector2d place_m = shown_m - Subdivision_m(first_m, known);
  return FromPlate_m(Turned(place_m - Vector2d(m.offset_m[0], m.offset_m[1]), -m.rotation_rad), known) -
         p.Commanded_m();
}

void SetNoise(const CircularSettings& s, CirclePoint& p) {
  const StatedNoise noise = StatedNoiseOf(s, p.is_bar, p.radius_m);
  p.u_radial_m = noise.radial_m;
  if (p.has_angle) p.u_tangential_m = noise.tangential_m;
  const Eigen::Array2d u(noise.radial_m, noise.tangential_m), steps(noise.radial_steps_m, noise.tangential_steps_m);
  if (!(u > 0.0).all()) return;
  p.of_machine = (s.machine.noise_m / u).square();
  p.of_steps = (steps / u).square();
}

bool IsReadByDrive(const Reading& r, const Scenario& scenario) {
  const std::vector<CircularSetup>& setups = CircularOf(scenario).procedure.setups;
  const auto setup = static_cast<std::size_t>(r.setup);
  return setup < setups.size() && setups[setup].IsDrive();
}

}  // namespace

std::vector<CirclePoint> PointsOf(const std::vector<Reading>& readings, const Scenario& scenario) {
  using namespace benches::circular;
  std::vector<CirclePoint> points;
  for (const Reading& r : WithAngles(readings)) {
    const Deviation shown = DeviationOf(r);
    if (r.status != ReadingStatus::kOk || !std::isfinite(shown.radial_m)) continue;
    CirclePoint& p = points.emplace_back();
    p.setup = r.setup;
    p.pass = r.pass;
    p.direction = r.direction;
    p.is_bar = IsOfBar(r);
    p.has_angle = ShowsAngle(r);
    p.is_drive = !p.is_bar && IsReadByDrive(r, scenario);
    p.commanded_rad = r.target_rad;
    p.radius_m = Radius_m(r);
    p.rate_rad_s = r.velocity_rad_s;
    p.feed_m_s = kFeed_m_s(r);
    if (std::isfinite(r.temperature_degC)) p.above_K = r.temperature_degC - scenario.environment.reference_degC;
    p.radial_m = shown.radial_m;
    p.tangential_m = shown.tangential_m;
    SetNoise(CircularOf(scenario), p);
  }
  return points;
}

namespace {

AxisPair WaveOf(double amplitude, double phase_rad) {
  return {amplitude * std::cos(phase_rad), amplitude * std::sin(phase_rad)};
}

CircleErrors BarOf(const BarSettings& bar) {
  CircleErrors errors;
  errors.bar_gain = bar.gain_error;
  errors.bar_cubic_per_m2 = bar.cubic_per_m2;
  errors.bar_expansion_per_K = bar.expansion_per_K;
  errors.ball2_m = WaveOf(bar.ball_m[0], 2.0 * bar.ball_azimuth_rad[0]);
  errors.ball3_m = WaveOf(bar.ball_m[1], 3.0 * bar.ball_azimuth_rad[1]);
  return errors;
}

}  // namespace

CircleConstants ConstantsOf(const CircularSettings& s) {
  return {s.machine.span_m, s.machine.cyclic_pitch_m, s.machine.spike_time_s, s.bar.height_m,
          s.bar.latency_s,  s.encoder.tilt_rad,       s.grid.scale,           s.grid.shear_rad,
          s.grid.sde_m,     s.grid.period_m,          BarOf(s.bar),           s.machine.lag_kind == "fixed_delay"};
}

Vector2d Shown_m(const CirclePoint& p, const CircleErrors& e, const CircleMounting& m,
                 const CircleConstants& known, CircleMemo& memo) {
  return p.is_bar ? BarShown_m(p, e, m, known, memo) : GridShown_m(p, e, m, known, memo);
}

Vector2d Shown_m(const CirclePoint& p, const CircleErrors& e, const CircleMounting& m, const CircleConstants& known) {
  CircleMemo memo;
  return Shown_m(p, e, m, known, memo);
}

Vector2d Deviation_m(const CirclePoint& p, const CircleErrors& e, const CircleMounting& m,
                     const CircleConstants& known) {
  if (!p.is_bar) return FromGrid_m(p, m, known);
  return p.has_angle ? FromBar_m(p, e, m, known) : FromRadialBar_m(p, e, m, known);
}

const std::vector<CircleUnknown>& CircleUnknowns() {
  using units::um, units::arcsec;
  using enum CircleUnknown::Needs;
  using E = CircleErrors;
  constexpr double kSmall_m = 0.1 * um, kPpm = 1e-6;
  static const std::vector<CircleUnknown> unknowns = {
      {"machine.lag_x_s", "s", 1.0, 1e-4, [](E& e) -> double& { return e.lag_s[0]; }, kAngle},
      {"machine.lag_y_s", "s", 1.0, 1e-4, [](E& e) -> double& { return e.lag_s[1]; }, kAngle},
      {"machine.scale_x_um_m", "um/m", um, kPpm, [](E& e) -> double& { return e.scale[0]; }, kAngle},
      {"machine.scale_y_um_m", "um/m", um, kPpm, [](E& e) -> double& { return e.scale[1]; }, kAngle},
      {"machine.squareness_arcsec", "arcsec", arcsec, arcsec, [](E& e) -> double& { return e.squareness_rad; },
       kNothing},
      {"machine.servo_mismatch_s", "s", 1.0, 1e-4, [](E& e) -> double& { return e.lag_mismatch_s; }, kRadiusOnly},
      {"machine.servo_mean_square_s2", "s2", 1.0, 1e-6, [](E& e) -> double& { return e.lag_mean_square_s2; }, kRadiusAtFeeds},
      {"machine.scale_mismatch_um_m", "um/m", um, kPpm, [](E& e) -> double& { return e.scale_mismatch; }, kRadiusOnly},
      {"machine.straightness_x_um", "um", um, kSmall_m, [](E& e) -> double& { return e.bow_m[0]; }, kNothing},
      {"machine.straightness_y_um", "um", um, kSmall_m, [](E& e) -> double& { return e.bow_m[1]; }, kNothing},
      {"machine.straightness3_x_um", "um", um, kSmall_m, [](E& e) -> double& { return e.s_shape_m[0]; }, kAngle},
      {"machine.straightness3_y_um", "um", um, kSmall_m, [](E& e) -> double& { return e.s_shape_m[1]; }, kAngle},
      {"machine.backlash_x_um", "um", um, kSmall_m, [](E& e) -> double& { return e.backlash_m[0]; }, kNothing},
      {"machine.backlash_y_um", "um", um, kSmall_m, [](E& e) -> double& { return e.backlash_m[1]; }, kNothing},
      {"machine.spike_x_um", "um", um, kSmall_m, [](E& e) -> double& { return e.spike_m[0]; }, kNothing},
      {"machine.spike_y_um", "um", um, kSmall_m, [](E& e) -> double& { return e.spike_m[1]; }, kNothing},
      {"machine.cyclic_x_sine_um", "um", um, kSmall_m, [](E& e) -> double& { return e.cyclic_sine_m[0]; },
       kNothing},
      {"machine.cyclic_x_cosine_um", "um", um, kSmall_m, [](E& e) -> double& { return e.cyclic_cosine_m[0]; },
       kNothing},
      {"machine.cyclic_y_sine_um", "um", um, kSmall_m, [](E& e) -> double& { return e.cyclic_sine_m[1]; },
       kNothing},
      {"machine.cyclic_y_cosine_um", "um", um, kSmall_m, [](E& e) -> double& { return e.cyclic_cosine_m[1]; },
       kNothing},
      {"machine.expansion_x_um_m_K", "um/m/K", um, kPpm, [](E& e) -> double& { return e.expansion_per_K[0]; },
       kTemperature},
      {"machine.expansion_y_um_m_K", "um/m/K", um, kPpm, [](E& e) -> double& { return e.expansion_per_K[1]; },
       kTemperature},
      {"machine.drift_x_um_K", "um/K", um, kSmall_m, [](E& e) -> double& { return e.drift_m_per_K[0]; },
       kTemperature},
      {"machine.drift_y_um_K", "um/K", um, kSmall_m, [](E& e) -> double& { return e.drift_m_per_K[1]; },
       kTemperature},
      {"bar.gain_error", "1", 1.0, 1e-3, [](E& e) -> double& { return e.bar_gain; }, kBarShown},
      {"bar.cubic_per_mm2", "per_mm2", 1e6, 1e5, [](E& e) -> double& { return e.bar_cubic_per_m2; }, kBarShown},
      {"bar.expansion_um_m_K", "um/m/K", um, kPpm, [](E& e) -> double& { return e.bar_expansion_per_K; },
       kBarAndTemperature},
      {"bar.ball2_cosine_um", "um", um, kSmall_m, [](E& e) -> double& { return e.ball2_m[0]; }, kBar},
      {"bar.ball2_sine_um", "um", um, kSmall_m, [](E& e) -> double& { return e.ball2_m[1]; }, kBar},
      {"bar.ball3_cosine_um", "um", um, kSmall_m, [](E& e) -> double& { return e.ball3_m[0]; }, kBar},
      {"bar.ball3_sine_um", "um", um, kSmall_m, [](E& e) -> double& { return e.ball3_m[1]; }, kBar},
      {"encoder.eccentricity_cosine_arcsec", "arcsec", arcsec, arcsec,
       [](E& e) -> double& { return e.eccentricity_rad[0]; }, kBar},
      {"encoder.eccentricity_sine_arcsec", "arcsec", arcsec, arcsec,
       [](E& e) -> double& { return e.eccentricity_rad[1]; }, kBar},
      {"encoder.ellipticity_cosine_arcsec", "arcsec", arcsec, arcsec,
       [](E& e) -> double& { return e.ellipticity_rad[0]; }, kBar},
      {"encoder.ellipticity_sine_arcsec", "arcsec", arcsec, arcsec,
       [](E& e) -> double& { return e.ellipticity_rad[1]; }, kBar},
      {"encoder.latency_s", "s", 1.0, 1e-4, [](E& e) -> double& { return e.encoder_latency_s; }, kBar}};
  return unknowns;  // constant
}

}  // namespace twinbench::separate::circular
