#include "twin/diagnose/turntable/turntable_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/core/errors.h"
#include "twin/core/units.h"
#include "twin/diagnose/engine/noise_model.h"
#include "twin/diagnose/engine/projector.h"
#include "twin/diagnose/engine/schedule.h"
#include "twin/diagnose/turntable/unknowns.h"

namespace twinbench::diagnose::turntable {
namespace {

using units::arcsec;

constexpr int kFewest = 12;
constexpr double kLeastNoise_rad = 1e-4 * arcsec;

std::vector<Reading> Usable(const std::vector<Reading>& readings) {
  std::vector<Reading> used;
  std::ranges::copy_if(readings, std::back_inserter(used), [](const Reading& r) {
    return r.status == ReadingStatus::kOk && std::isfinite(r.autocollimator_yaw_rad) &&
           std::isfinite(r.autocollimator_tilt_rad) && std::isfinite(r.target_rad) &&
           std::isfinite(r.reference_rad);
  });
  if (std::ssize(used) < kFewest)
    throw InputError("readings", fmt::format("{} of {} have both values", used.size(), readings.size()),
                     fmt::format("at least {}", kFewest));
  return used;
}

Eigen::MatrixXd AsRead_rad(const std::vector<Reading>& used) {
  Eigen::MatrixXd read_rad(std::ssize(used), kAxes);
  for (Eigen::Index i = 0; i < read_rad.rows(); ++i) {
    const Reading& r = used[static_cast<std::size_t>(i)];
    read_rad.row(i) << r.autocollimator_yaw_rad, r.autocollimator_tilt_rad;
  }
  return read_rad;
}

/// Rows as readings x axes.
Eigen::MatrixXd ByReading(const Eigen::VectorXd& rows) {
  return Eigen::Map<const Eigen::MatrixXd>(rows.data(), kAxes, rows.size() / kAxes).transpose();
}

Eigen::VectorXd SweepSteps_rad(const Schedule& s, const Places& places) {
  Eigen::VectorXd steps_rad = Eigen::VectorXd::Zero(s.Readings());
  for (Eigen::Index i = 0; i < steps_rad.size(); ++i) {
    const int sweep = places.sweep[static_cast<std::size_t>(i)];
    if (sweep >= 0) steps_rad[i] = s.target_rad[i] - places.sweep_centre_rad[static_cast<std::size_t>(sweep)];
  }
  return steps_rad;
}

double Scatter_rad(const TableSettings& table, Axis axis) {
  const auto& sd = table.repeatability_sd;
  const auto of = [&sd](Component c) { return sd[static_cast<std::size_t>(c)]; };
  // The line of sight may be any horizontal one of the table.
  return axis == kX ? of(Component::kEz) : std::hypot(of(Component::kEx), of(Component::kEy)) / std::sqrt(2.0);
}

double SeatingEffect_rad(const Scenario& scenario) {
  double scatter_rad = 0.0;
  for (const EffectSettings& e : scenario.effects) {
    if (e.name == "multitooth_seating") scatter_rad = std::hypot(scatter_rad, e.parameters.at("scatter"));
  }
  return scatter_rad;
}

Eigen::VectorXd Sigma_rad(int readings, const Scenario& scenario) {
  Eigen::VectorXd sigma_rad(kAxes * readings);
  for (Eigen::Index row = 0; row < sigma_rad.size(); ++row) {
    const auto axis = static_cast<Axis>(row % kAxes);
    double tables_rad = std::hypot(Scatter_rad(scenario.target, axis), Scatter_rad(scenario.reference, axis));
    if (axis == kX) tables_rad = std::hypot(tables_rad, SeatingEffect_rad(scenario));
    sigma_rad[row] = std::max(std::hypot(scenario.autocollimator.noise_rad, tables_rad), kLeastNoise_rad);
  }
  return sigma_rad;
}

/// Every row of the unknowns times what a reading shows of a small change.
void Stretch(const Eigen::MatrixXd& slopes, Nuisance& nuisance) {
  nuisance.jacobian = (1.0 + AsRows(slopes).array()).matrix().asDiagonal() * nuisance.jacobian;
}

/// The best prediction with what is known to some extent held at what is stated (Gauss-Newton: errors that depend
/// on the reading are looked up where the prediction lies).
void FitBaseline(const Scenario& scenario, TurntableRun& turntable) {
  const int rounds = DependsOnReading(scenario) ? 8 : 1;
  LinearRun& run = turntable.run;
  const NoiseModel noise{run.sigma, 0.0};
  const Eigen::VectorXd sweep_rad = SweepSteps_rad(run.schedule, turntable.places);
  const Nuisance free = FreeUnknowns(turntable.places, BelievedInstrument(scenario), run.schedule);
  Eigen::MatrixXd& shown_rad = turntable.context.shown_rad;
  shown_rad = ByReading(run.observed);
  KnownSignals known = KnownSignalsOf(shown_rad, sweep_rad, scenario, turntable.context);
  Eigen::VectorXd optics_rad = AsRows(known.of_optics_rad);
  for (int round = 0; round < rounds; ++round) {
    run.residual = run.observed - optics_rad - AsRows(known.behind_rad);
    Nuisance stretched = free;
    if (round > 0) Stretch(SlopesOfReading(shown_rad, scenario, turntable.context), stretched);
    const Projector projector(noise.Whiten(run, stretched.jacobian), stretched);
    optics_rad += free.jacobian * projector.Solve(noise.Whiten(run, Eigen::MatrixXd(run.residual))).col(0);
    shown_rad = ByReading(optics_rad);
    known = KnownSignalsOf(shown_rad, sweep_rad, scenario, turntable.context);
  }
  run.residual = run.observed - optics_rad - AsRows(known.behind_rad);
}

double Rms(const Eigen::VectorXd& values) {
  return std::sqrt((values.array() - values.mean()).square().mean());
}

}  // namespace

TurntableRun BuildRun(const std::vector<Reading>& readings, const Scenario& scenario) {
  const std::vector<Reading> used = Usable(readings);
  TurntableRun turntable;
  turntable.left_out = static_cast<int>(std::ssize(readings) - std::ssize(used));
  LinearRun& run = turntable.run;
  run.bench = scenario.bench;
  run.schedule = ScheduleOf(used);
  turntable.places = PlacesOf(run.schedule);
  turntable.context = ContextOf(run.schedule, scenario);
  run.channels = {kAxisNames.begin(), kAxisNames.end()};
  run.unit = "arcsec";
  run.to_SI = arcsec;
  run.noise_free = scenario.noise_free;
  run.sigma = Sigma_rad(run.schedule.Readings(), scenario);
  run.observed = AsRows(AsRead_rad(used));
  FitBaseline(scenario, turntable);
  run.nuisance = AllUnknowns(turntable.places, BelievedInstrument(scenario), turntable.context, scenario);
  Stretch(SlopesOfReading(turntable.context.shown_rad, scenario, turntable.context), run.nuisance);
  return turntable;
}

TurntableRun LinearisedAbout(const std::vector<EffectSettings>& found, const std::vector<Reading>& readings,
                             const Scenario& scenario) {
  Scenario with_found = scenario;
  with_found.effects.insert(with_found.effects.end(), found.begin(), found.end());
  TurntableRun turntable = BuildRun(readings, with_found);
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(turntable.context.Readings());
  const auto behind_rad = [&](const Scenario& s) {
    return AsRows(KnownSignalsOf(turntable.context.shown_rad, none, s, turntable.context).behind_rad);
  };
  turntable.run.residual += behind_rad(with_found) - behind_rad(scenario);
  return turntable;
}

std::string BiasInWords(const Places& places, const Eigen::VectorXd& unknowns) {
  if (places.circle_blocks == 0) return "no error of the turntable";
  Eigen::VectorXd index(places.circle_blocks), tilt(places.circle_blocks);
  for (int b = 0; b < places.circle_blocks; ++b) {
    index[b] = unknowns[kAxes * b + kX];
    tilt[b] = unknowns[kAxes * b + kY];
  }
  const double index_arcsec = Rms(index) / arcsec, tilt_arcsec = Rms(tilt) / arcsec;
  if (std::max(index_arcsec, tilt_arcsec) < 1e-6) return "no error of the turntable";
  if (index_arcsec >= tilt_arcsec) return fmt::format("turntable ez up to {:.2g} arcsec rms", index_arcsec);
  return fmt::format("turntable tilt up to {:.2g} arcsec rms", tilt_arcsec);
}

}  // namespace twinbench::diagnose::turntable
