#include "twin/diagnose/rotary/rotary_run.h"

#include <algorithm>
#include <cmath>

#include "twin/core/errors.h"
#include "twin/core/units.h"
#include "twin/diagnose/engine/projector.h"
#include "twin/diagnose/rotary/known_effects.h"
#include "twin/diagnose/rotary/rotary_readings.h"
#include "twin/measure/calibrate.h"
#include "twin/measure/grating_model.h"
#include "twin/separate/prediction.h"
#include "twin/separate/separate.h"

namespace twinbench::diagnose::rotary {
namespace {

using separate::Design;
using Sparse = Eigen::SparseMatrix<double, Eigen::RowMajor>;

constexpr int kFewestReadings = 24;
constexpr int kCalibrationUnknowns = 10;  // four gains, two rolls, two distances, wavelength, incidence
constexpr double kTableAngleSd_rad = 500.0 * units::arcsec;
constexpr double kTableLengthSd_m = 0.5 * units::mm;
constexpr double kMountAngleSd_rad = 0.05;
constexpr double kMountLengthSd_m = 10.0 * units::mm;

/// What the fit needs of each used reading besides the schedule.
struct Sweep {
  double yaw_rad = 0.0, tilt_rad = 0.0;  // of the calibration's goniometer
};

/// Everything between the readings and the linear run.
struct Fit {
  RotaryRun result;
  std::vector<Sweep> sweep;
  std::vector<separate::Sample> sample;  // setup < 0: calibration phase
  Vector4 calibration_mount = Vector4::Zero();
  Eigen::VectorXd x;
  Eigen::VectorXd known;  // effects that the scenario already holds, by row
};

/// Only what FindLayout looks at.
measure::Motion LabelOf(const Reading& r) {
  measure::Motion m;
  m.reading = r.reading;
  m.setup = r.setup;
  m.phase = r.phase;
  m.target_rad = r.target_rad;
  m.reference_rad = r.reference_rad;
  m.status = ReadingStatus::kOk;
  return m;
}

/// The published equations add the reference's wobble as it is (eq. 13), however the grating was clamped.
separate::LayoutOptions LayoutOf(const Scenario& scenario, bool published) {
  separate::LayoutOptions layout = separate::OptionsFrom(scenario).layout;
  if (published) layout.clamping = separate::Clamping::kReseat;
  const auto reclamped = [](const EffectSettings& e) { return e.name == "reclamp_frame"; };
  if (std::any_of(scenario.effects.begin(), scenario.effects.end(), reclamped)) {
    layout.clamping = separate::Clamping::kReclamp;
  }
  return layout;
}

void FindSamples(const std::vector<Reading>& used, const Scenario& scenario, Fit& fit) {
  std::vector<measure::Motion> labels;
  std::transform(used.begin(), used.end(), std::back_inserter(labels), LabelOf);
  separate::Layout layout =
      separate::FindLayout(labels, fit.result.bench.nominal, LayoutOf(scenario, fit.result.bench.published));
  fit.sample.assign(used.size(), {0, -1, 0, 0});
  for (const separate::Sample& s : layout.samples) fit.sample[s.motion] = s;
  for (const separate::SetUp& s : layout.design.setups) fit.result.shifts.push_back(s.shift);
  fit.result.design = std::move(layout.design);
  for (const Reading& r : used) {
    const bool swept = r.phase == Phase::kCalibration;
    fit.sweep.push_back(swept ? Sweep{r.autocollimator_yaw_rad, r.autocollimator_tilt_rad} : Sweep{});
  }
}

int MountAt(const Fit& fit) {
  return fit.result.design.Unknowns();
}
int CalibrationAt(const Fit& fit) {
  return MountAt(fit) + separate::kMountUnknowns;
}
int UnknownsOf(const Fit& fit) {
  return CalibrationAt(fit) + kCalibrationUnknowns;
}

Vector4 CalibrationMotion(const Fit& fit, const Sweep& sweep) {
  const Vector4 mount = fit.x.segment<4>(MountAt(fit)).cwiseQuotient(separate::UnitScale());
  const Matrix3 swept = measure::MotionRotation({sweep.yaw_rad, sweep.tilt_rad, 0.0, 0.0});
  const Matrix3 turn = swept * measure::MotionRotation(mount);
  return {std::atan2(turn(1, 0), turn(0, 0)), std::atan2(turn(2, 1), turn(2, 2)), -std::asin(turn(2, 0)), mount[3]};
}

void PredictMotions(Fit& fit) {
  std::vector<separate::Cell> cells;
  for (const separate::Sample& s : fit.sample) {
    if (s.setup >= 0) cells.push_back({s.setup, s.target, measure::Matrix4::Zero()});
  }
  const Eigen::VectorXd circles =
      separate::PredictCells(fit.result.design, cells, fit.x.head(MountAt(fit)), fit.result.bench.nominal);
  fit.result.motion.clear();
  Eigen::Index next = 0;
  for (std::size_t i = 0; i < fit.sample.size(); ++i) {
    if (fit.sample[i].setup < 0) {
      fit.result.motion.push_back(CalibrationMotion(fit, fit.sweep[i]));
    } else {
      fit.result.motion.push_back(circles.segment<4>(4 * next++).cwiseQuotient(separate::UnitScale()));
    }
  }
}

OpticalBench BenchAt(const Fit& fit, std::size_t i, const Scenario& scenario) {
  const double T = fit.result.run.schedule.temperature_degC[static_cast<Eigen::Index>(i)];
  const double above_K = std::isfinite(T) ? T - scenario.environment.reference_degC : 0.0;
  return WithKnownEffects(fit.result.bench, scenario, above_K);
}

/// One calibrated parameter of the bench, with the size of its prior.
double& CalibratedParameter(OpticalBench& bench, int k) {
  const auto at = static_cast<std::size_t>(k);
  if (k < 4) return bench.gain_error[at];
  if (k < 6) return bench.roll_rad[at - 4];
  if (k < 8) return bench.distance_error_m[at - 6];
  return k == 8 ? bench.wavelength_error_m : bench.incidence_rad;
}
double CalibrationPrior(int k) {
  const CalibrationPriors prior;
  if (k < 4) return prior.gain;
  if (k < 6) return prior.roll_rad;
  if (k < 8) return prior.distance_m;
  return k == 8 ? prior.wavelength_m : prior.incidence_rad;
}

using Block = Eigen::Triplet<double>;

void AddMotionColumns(const Fit& fit, std::size_t i, const Eigen::Matrix4d& K, std::vector<Block>& entries) {
  const int row = kChannels * static_cast<int>(i);
  const Eigen::Matrix4d scaled = K * separate::UnitScale().cwiseInverse().asDiagonal();
  const auto add = [&](int column, const Vector4& d_motion) {
    const Vector4 shown = scaled * d_motion;
    for (int c = 0; c < kChannels; ++c) {
      if (shown[c] != 0.0) entries.emplace_back(row + c, column, shown[c]);
    }
  };
  if (fit.sample[i].setup < 0) {
    for (int k = 0; k < separate::kMountUnknowns; ++k) add(MountAt(fit) + k, Vector4::Unit(k));
    return;
  }
  const separate::StopModel stop =
      separate::ModelStop(fit.result.design, fit.sample[i].setup, fit.sample[i].target);
  for (int k = 0; k < stop.columns; ++k) add(stop.column[static_cast<std::size_t>(k)], stop.d.col(k));
}

void AddCalibrationColumns(const Fit& fit, std::size_t i, OpticalBench bench, std::vector<Block>& entries) {
  for (int k = 0; k < kCalibrationUnknowns; ++k) {
    double& parameter = CalibratedParameter(bench, k);
    const double step = CalibrationPrior(k), kept = parameter;
    parameter = kept + step;
    const Vector4 above = ShownSpots(bench, fit.result.motion[i]);
    parameter = kept - step;
    const Vector4 slope = (above - ShownSpots(bench, fit.result.motion[i])) / (2.0 * step);
    parameter = kept;
    for (int c = 0; c < kChannels; ++c) {
      entries.emplace_back(kChannels * static_cast<int>(i) + c, CalibrationAt(fit) + k, slope[c]);
    }
  }
}

/// Residual and Jacobian at the present unknowns.
void Linearise(const Scenario& scenario, Fit& fit) {
  LinearRun& run = fit.result.run;
  PredictMotions(fit);
  std::vector<Block> entries;
  for (std::size_t i = 0; i < fit.sample.size(); ++i) {
    const OpticalBench bench = BenchAt(fit, i, scenario);
    const auto rows = kChannels * static_cast<Eigen::Index>(i);
    run.residual.segment<4>(rows) =
        run.observed.segment<4>(rows) - ShownSpots(bench, fit.result.motion[i]) - fit.known.segment<4>(rows);
    AddMotionColumns(fit, i, ShownJacobian(bench, fit.result.motion[i]), entries);
    if (!bench.published) AddCalibrationColumns(fit, i, bench, entries);
  }
  run.nuisance.jacobian = Sparse(run.observed.size(), UnknownsOf(fit));
  run.nuisance.jacobian.setFromTriplets(entries.begin(), entries.end());
}

Eigen::VectorXd PriorPrecision(const Fit& fit) {
  const Design& design = fit.result.design;
  const double L = separate::kLengthUnit_m;
  Eigen::VectorXd sd(UnknownsOf(fit));
  sd.setConstant(kTableAngleSd_rad);
  for (int i = 0; i < design.n; ++i) {
    for (const auto s : {separate::Series::kTargetDy, separate::Series::kRefDx, separate::Series::kRefDy}) {
      sd[design.Column(s, i)] = kTableLengthSd_m / L;
    }
  }
  const Vector4 mount(kMountAngleSd_rad, kMountAngleSd_rad, kMountAngleSd_rad, kMountLengthSd_m / L);
  for (int s = 0; s < std::ssize(design.setups); ++s) {
    sd.segment<4>(design.MountColumn(s)) = mount;
    if (design.setups[static_cast<std::size_t>(s)].clamping == separate::Clamping::kReclamp) continue;
    sd.segment<4>(design.SeatColumn(s)) << kMountAngleSd_rad, kMountAngleSd_rad, kMountLengthSd_m / L,
        kMountLengthSd_m / L;
  }
  sd.segment<4>(MountAt(fit)) = mount;
  for (int k = 0; k < kCalibrationUnknowns; ++k) sd[CalibrationAt(fit) + k] = CalibrationPrior(k);
  return sd.cwiseAbs2().cwiseInverse();
}

/// Gauss-Newton; the calibrated parameters stay at what is believed, only the linear run lets them move.
void Solve(const Scenario& scenario, Fit& fit) {
  constexpr int kIterations = 4;  // converges quadratically from zero: 20 arcsec squared is below a nanoradian
  LinearRun& run = fit.result.run;
  fit.x = Eigen::VectorXd::Zero(UnknownsOf(fit));
  Linearise(scenario, fit);
  const Eigen::VectorXd weight = run.sigma.cwiseInverse();
  for (int k = 0; k < kIterations; ++k) {
    const Projector projector(Sparse(weight.asDiagonal() * run.nuisance.jacobian), run.nuisance);
    const Eigen::VectorXd data = run.residual + run.nuisance.jacobian * fit.x;
    fit.x = projector.Solve(weight.cwiseProduct(data));
    fit.x.tail(kCalibrationUnknowns).setZero();
    Linearise(scenario, fit);
  }
}

void AddPatterns(const Fit& fit, LinearRun& run) {
  const char* const names[] = {"yaw", "tilt", "roll", "lateral"};  // ez, ex, ey, dy
  for (int k = 0; k < 4; ++k) run.patterns.push_back({names[k], fit.result.shown_by_motion.col(k)});
}

}  // namespace

SignalContext ContextOf(const RotaryRun& rotary, const Scenario& scenario, const Eigen::VectorXd& shown_m) {
  constexpr double kStep_rad = 1e-6;
  SignalContext context{rotary.run,
                        rotary.shown_by_motion,
                        {},
                        rotary.bench.nominal.SpotFromTarget().z(),
                        scenario.environment.reference_degC,
                        rotary.bench.nominal.sensitivity_V_m,
                        rotary.scanned_before,
                        shown_m,
                        rotary.sample_noise_V};
  for (int k = 0; k < 2; ++k) {
    OpticalBench turned = rotary.bench;
    (k == 0 ? turned.laser_yaw_rad : turned.laser_pitch_rad) += kStep_rad;
    context.shown_by_laser.col(k) =
        (ShownSpots(turned, Vector4::Zero()) - ShownSpots(rotary.bench, Vector4::Zero())) / kStep_rad;
  }
  return context;
}

RotaryRun BuildRun(const std::vector<Reading>& readings, const Scenario& scenario, bool published) {
  std::vector<Reading> used;
  std::copy_if(readings.begin(), readings.end(), std::back_inserter(used), IsUsable);
  if (std::ssize(used) < kFewestReadings) {
    throw InputError(
        "readings", std::to_string(used.size()) + " usable readings",
        "calibration and full-circle readings with four voltages, at least " + std::to_string(kFewestReadings));
  }
  Fit fit;
  RotaryRun& result = fit.result;
  result.bench = BelievedBench(scenario);
  result.bench.published = published;
  const auto other_phase = [](const Reading& r) {
    return r.phase != Phase::kCalibration && r.phase != Phase::kFullCircle;
  };
  result.left_out = static_cast<int>(std::ssize(readings) - std::ssize(used) -
                                     std::count_if(readings.begin(), readings.end(), other_phase));
  LinearRun& run = result.run;
  run.schedule = ScheduleOf(used);
  run.channels.assign(kChannelNames.begin(), kChannelNames.end());
  run.unit = "um";
  run.to_SI = units::um;
  run.observed = ObservedOf(used, result.bench.nominal);
  run.residual = run.observed;
  run.sigma = SigmaOf(used, scenario, result.bench);
  run.noise_free = IsNoiseFree(used);
  result.sample_noise_V = SampleNoise_V(used, scenario);
  result.scanned_before = ScannedBefore(scenario.adc.scan_list);
  FindSamples(used, scenario, fit);
  result.shown_by_motion = ShownJacobian(result.bench, Vector4::Zero());
  fit.known = KnownSignal(scenario, ContextOf(result, scenario, run.observed));
  run.nuisance.blocks = result.design.n;
  run.nuisance.block_size = separate::kTargetSeries;
  run.nuisance.prior_precision = PriorPrecision(fit);
  Solve(scenario, fit);
  AddPatterns(fit, run);
  return result;
}

}  // namespace twinbench::diagnose::rotary
