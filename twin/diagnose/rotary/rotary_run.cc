#include "twin/diagnose/rotary/rotary_run.h"

#include <algorithm>
#include <utility>

#include "twin/core/errors.h"
#include "twin/core/units.h"
#include "twin/diagnose/engine/projector.h"
#include "twin/model/course.h"
#include "twin/diagnose/rotary/free_parameters.h"
#include "twin/diagnose/rotary/linearisation.h"
#include "twin/diagnose/rotary/rotary_readings.h"
#include "twin/diagnose/rotary/stance.h"

namespace twinbench::diagnose::rotary {
namespace {

std::vector<Reading> UsedOf(const std::vector<Reading>& readings) {
  constexpr int kFewest = 24;
  std::vector<Reading> used;
  std::copy_if(readings.begin(), readings.end(), std::back_inserter(used), IsUsable);
  if (std::ssize(used) >= kFewest) return used;
  throw InputError("readings", std::to_string(used.size()) + " usable readings",
                   "calibration and full-circle readings with four voltages, at least " + std::to_string(kFewest));
}

/// Readings of the phases used here that are not usable.
int LeftOut(const std::vector<Reading>& readings, std::size_t used) {
  const auto wanted = std::ranges::count_if(
      readings, [](const Reading& r) { return r.phase == Phase::kCalibration || r.phase == Phase::kFullCircle; });
  return static_cast<int>(wanted) - static_cast<int>(used);
}

/// What is believed of the bench before its readings are looked at.
void SetBench(const Scenario& scenario, bool published, RotaryRun& rotary) {
  rotary.bench = BelievedBench(scenario);
  rotary.bench.published = published;
  rotary.shown_by_motion = ShownJacobian(rotary.bench, Vector4::Zero());
  rotary.scanned_before = ScannedBefore(scenario.adc.scan_list);
}

void SetReadings(const std::vector<Reading>& used, const Scenario& scenario, RotaryRun& rotary) {
  LinearRun& run = rotary.run;
  run.bench = scenario.bench;
  run.schedule = model::CourseOf(used);
  run.channels.assign(kChannelNames.begin(), kChannelNames.end());
  run.unit = "um";
  run.to_SI = units::um;
  run.observed = ObservedOf(used, rotary.bench.nominal);
  run.residual = run.observed;
  run.sigma = SigmaOf(used, scenario, rotary.bench);
  run.noise_free = IsNoiseFree(used);
  rotary.sample_noise_V = SampleNoise_V(used, scenario);
  const char* const motions[] = {"yaw", "tilt", "roll", "lateral"};  // ez, ex, ey, dy
  for (int k = 0; k < 4; ++k) run.patterns.push_back({motions[k], rotary.shown_by_motion.col(k)});
}

/// The unknowns that there are, and how far each may be from zero.
void SetUnknowns(separate::Design design, RotaryRun& rotary) {
  rotary.design = std::move(design);
  for (const separate::SetUp& s : rotary.design.setups) rotary.shifts.push_back(s.shift);
  Nuisance& nuisance = rotary.run.nuisance;
  nuisance.blocks = rotary.design.n;
  nuisance.block_size = separate::kTargetSeries;
  nuisance.prior_precision = PriorPrecision(rotary.design);
}

/// One Gauss-Newton step from x. The calibrated parameters are held at what is believed, and the others are the
/// best beside that: what every reading should show must not be off by what a parameter has taken up and then lost.
/// Only the linear run lets them move.
Eigen::VectorXd Improved(const Eigen::VectorXd& x, const LinearRun& run) {
  constexpr double kHeld = 1e12;  // times the prior precision
  Nuisance nuisance = run.nuisance;
  nuisance.prior_precision.tail(kCalibrated) *= kHeld;
  const Eigen::VectorXd weight = run.sigma.cwiseInverse();
  const Projector projector(weight.asDiagonal() * run.nuisance.jacobian, nuisance);
  const Eigen::VectorXd data = run.residual + run.nuisance.jacobian * x;
  Eigen::VectorXd improved = projector.Solve(weight.cwiseProduct(data));
  improved.tail(kCalibrated).setZero();
  return improved;
}

void Fit(const Scenario& scenario, const std::vector<Stance>& stances, const model::Follow* twin,
         RotaryRun& rotary) {
  constexpr int kIterations = 4;  // converges quadratically from zero: 20 arcsec squared is below a nanoradian
  Eigen::VectorXd x = Eigen::VectorXd::Zero(UnknownsOf(rotary.design));
  Linearise(scenario, stances, x, twin, rotary);
  for (int k = 0; k < kIterations; ++k) {
    x = Improved(x, rotary.run);
    Linearise(scenario, stances, x, twin, rotary);
  }
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
                        rotary.sample_noise_V,
                        std::max(scenario.target.settle_s, scenario.reference.settle_s)};
  for (int k = 0; k < 2; ++k) {
    OpticalBench turned = rotary.bench;
    (k == 0 ? turned.laser_yaw_rad : turned.laser_pitch_rad) += kStep_rad;
    context.shown_by_laser.col(k) =
        (ShownSpots(turned, Vector4::Zero()) - ShownSpots(rotary.bench, Vector4::Zero())) / kStep_rad;
  }
  context.shown_by_wavelength = ShownByWavelength(rotary.bench);
  return context;
}

RotaryRun BuildRun(const std::vector<Reading>& readings, const Scenario& scenario, const ForwardModel& model) {
  const std::vector<Reading> used = UsedOf(readings);
  RotaryRun rotary;
  rotary.left_out = LeftOut(readings, used.size());
  SetBench(scenario, model.published, rotary);
  SetReadings(used, scenario, rotary);
  Stances stances = FindStances(used, scenario, rotary.bench);
  SetUnknowns(std::move(stances.design), rotary);
  std::unique_ptr<model::Follow> twin;
  if (model.follow && !model.published) twin = model.follow(scenario, used);
  Fit(scenario, stances.of_reading, twin.get(), rotary);
  return rotary;
}

}  // namespace twinbench::diagnose::rotary
