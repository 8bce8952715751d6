#include "twin/benches/rotary_4dof/diagnosis/rotary_run.h"

#include <algorithm>
#include <utility>

#include "twin/benches/rotary_4dof/diagnosis/configuration.h"
#include "twin/benches/rotary_4dof/diagnosis/free_parameters.h"
#include "twin/benches/rotary_4dof/diagnosis/linearisation.h"
#include "twin/benches/rotary_4dof/diagnosis/rotary_readings.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/core/errors.h"
#include "twin/core/units.h"
#include "twin/diagnose/engine/projector.h"
#include "twin/diagnose/mean_of_runs.h"
#include "twin/model/course.h"

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

void SetReadings(const std::vector<Reading>& used, const Scenario& scenario, RotaryRun& rotary) {
  LinearRun& run = rotary.run;
  run.bench = scenario.bench;
  run.schedule = model::CourseOf(AtMiddleOfBlocks(used, RotaryOf(scenario).adc));
  run.channels.assign(kChannelNames.begin(), kChannelNames.end());
  run.unit = "um";
  run.to_SI = units::um;
  run.residual = run.observed;
  const std::vector<Vector4> still(used.size(), Vector4::Zero());
  run.sigma = SigmaOf(used, scenario, rotary.geometry,
                      {rotary.twin->Slope_m("mount.ez", still), rotary.twin->Slope_m("mount.ex", still)});
  run.rounding = RoundingStep_m(used, rotary.geometry);
  ScaleToMean(used, run);
  run.noise_free = IsNoiseFree(used);
  rotary.sample_noise_V = SampleNoise_V(used, scenario);
}

/// The ways in which the grating's motions show.
void SetPatterns(RotaryRun& rotary) {
  const std::array<const char*, 4> motions = {"yaw", "tilt", "roll", "lateral"};
  for (int k = 0; k < 4; ++k) {
    const std::string motion = motions[static_cast<std::size_t>(k)];
    rotary.shown_by_motion.col(k) = rotary.ResponseTo("grating." + motion).pattern;
    rotary.run.patterns.push_back({motion, rotary.shown_by_motion.col(k)});
  }
}

/// The unknowns that there are, and how far each may be from zero.
void SetUnknowns(separate::Design design, RotaryRun& rotary) {
  rotary.design = std::move(design);
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

/// Slopes hardly vary within some arcminutes: they are looked up again once.
/// @return the unknowns.
Eigen::VectorXd Fit(const std::vector<Configuration>& configurations, const RotaryTwin* without_effects, RotaryRun& rotary) {
  constexpr int kLookUps = 2, kSteps = 2;
  Eigen::VectorXd x = Eigen::VectorXd::Zero(UnknownsOf(rotary.design));
  Compare(configurations, x, without_effects, rotary);
  for (int look_up = 0; look_up < kLookUps; ++look_up) {
    Linearise(configurations, false, rotary);
    for (int step = 0; step < kSteps; ++step) {
      x = Improved(x, rotary.run);
      Compare(configurations, x, without_effects, rotary);
    }
  }
  Linearise(configurations, true, rotary);
  return x;
}

/// A run that is asked with its unknowns anywhere: twin, light and unknowns, no noise, no fit.
RotaryRun Asked(const std::vector<Reading>& used, const Scenario& scenario, const ForwardModel& model,
                std::vector<Configuration>& of_reading) {
  RotaryRun rotary;
  rotary.geometry = measure::NominalGeometry(scenario);
  rotary.published = model.published;
  rotary.twin = std::make_shared<const RotaryTwin>(model.follow, scenario, used, rotary.geometry);
  rotary.run.observed = ObservedOf(used, rotary.geometry);
  Configurations configurations = FindConfigurations(used, scenario, rotary.geometry, rotary.published);
  of_reading = std::move(configurations.of_reading);
  SetUnknowns(std::move(configurations.design), rotary);
  return rotary;
}

/// Tables and mountings move as the unknowns say; the calibrated constants are held and act by their slopes.
LeftByAnother LeftByAnotherOf(const std::vector<Reading>& used, const ForwardModel& model, const RotaryRun& rotary,
                              const Eigen::VectorXd& x) {
  struct Fitted {
    std::vector<Reading> used;
    ForwardModel model;
    Eigen::SparseMatrix<double, Eigen::RowMajor> jacobian;
    Eigen::VectorXd x;
  };
  const auto fitted = std::make_shared<const Fitted>(Fitted{used, model, rotary.run.nuisance.jacobian, x});
  return [fitted](const Scenario& other) -> LeftWhere {
    std::vector<Configuration> configurations;
    const RotaryRun of_other = Asked(fitted->used, other, fitted->model, configurations);
    if (UnknownsOf(of_other.design) != fitted->x.size()) return {};
    return [fitted, configurations, of_other](const Eigen::VectorXd& by) -> Eigen::VectorXd {
      Eigen::VectorXd moved = by;
      moved.tail(kCalibrated).setZero();
      RotaryRun there = of_other;
      Compare(configurations, fitted->x + moved, nullptr, there);
      return there.run.residual + fitted->jacobian * moved;
    };
  };
}

Scenario WithoutEffects(Scenario scenario) {
  scenario.effects.clear();
  scenario.empiricals.clear();
  return scenario;
}

}  // namespace

Response RotaryRun::ResponseTo(const std::string& point) const {
  const Eigen::VectorXd rows = twin->Slope_m(point, free);
  const Eigen::Map<const Eigen::Matrix<double, 4, Eigen::Dynamic>> slopes(rows.data(), 4, rows.size() / 4);
  const Eigen::VectorXd sizes = slopes.colwise().norm();
  const Eigen::VectorXd answers = (sizes.array() > 0.5 * sizes.maxCoeff()).cast<double>();
  const Vector4 pattern = slopes * answers / std::max(1.0, answers.sum());
  return {pattern, slopes.transpose() * pattern / std::max(pattern.squaredNorm(), 1e-300)};
}

RotaryRun BuildRun(const std::vector<Reading>& readings, const Scenario& scenario, const ForwardModel& model) {
  const std::vector<Reading> used = UsedOf(readings);
  std::vector<Configuration> configurations;
  RotaryRun rotary = Asked(used, scenario, model, configurations);
  SetReadings(used, scenario, rotary);
  rotary.left_out = LeftOut(readings, used.size());
  const Scenario bare = WithoutEffects(scenario);
  std::unique_ptr<const RotaryTwin> without_effects;
  if (model.published && scenario.effects.size() + scenario.empiricals.size() > 0)
    without_effects = std::make_unique<const RotaryTwin>(model.follow, bare, used, rotary.geometry);
  const Eigen::VectorXd x = Fit(configurations, without_effects.get(), rotary);
  SetPatterns(rotary);
  if (!model.published) rotary.run.left_by_another = LeftByAnotherOf(used, model, rotary, x);
  return rotary;
}

}  // namespace twinbench::diagnose::rotary
