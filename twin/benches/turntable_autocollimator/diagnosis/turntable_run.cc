#include "twin/benches/turntable_autocollimator/diagnosis/turntable_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "twin/benches/turntable_autocollimator/diagnosis/unknowns.h"
#include "twin/benches/turntable_autocollimator/settings.h"
#include "twin/core/errors.h"
#include "twin/core/units.h"
#include "twin/diagnose/at.h"
#include "twin/diagnose/engine/followed.h"
#include "twin/diagnose/engine/noise_model.h"
#include "twin/diagnose/engine/projector.h"
#include "twin/diagnose/mean_of_runs.h"
#include "twin/model/course.h"
#include "twin/model/signals.h"

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

double SeatingEffect_rad(const Scenario& scenario) {
  double scatter_rad = 0.0;
  for (const EffectSettings& e : scenario.effects) {
    if (e.name == "multitooth_seating") scatter_rad = std::hypot(scatter_rad, e.parameters.at("scatter"));
  }
  return scatter_rad;
}

/// Of an encoder that is read; beside a multi-tooth table it is not.
double EncoderScatter_rad(const TurntableSettings& own) {
  return own.HasPolygon() ? std::hypot(own.encoder.noise_rad, own.encoder.step_rad / std::sqrt(12.0)) : 0.0;
}

/// The course by nominal angles: where a polygon is nulled the encoder shows each of them with its scatter.
Schedule AtNominal(Schedule schedule, const TurntableSettings& own) {
  if (!own.HasPolygon()) return schedule;
  for (int i = 0; i < schedule.Readings(); ++i) {
    const int setup = std::clamp(schedule.setup[At(i)], 0, own.turntable_procedure.SetUps() - 1);
    const int face = static_cast<int>(std::lround(-schedule.reference_rad[i] / own.Pitch_rad()));
    schedule.target_rad[i] = own.FaceAngle_rad(setup, face);
  }
  return schedule;
}

constexpr double kNoWeight = 1e4;  // times the noise, where the twin shows nothing

/// Turns and tilts of the mirror (readings x axes) at their points of the twin: wherever they come from, the
/// autocollimator sees no more of them.
std::vector<model::Disturbance> AtPoints(const Eigen::MatrixXd& body_rad) {
  return {{"turntable.ez", body_rad.col(kX)}, {"turntable.ex", body_rad.col(kY)}};
}

Eigen::MatrixXd OrZero(const Eigen::MatrixXd& values) {
  return values.array().isFinite().select(values, 0.0);
}

Slopes SlopesAt(const Followed& twin, const Eigen::MatrixXd& body_rad) {
  const std::vector<model::Disturbance> at = AtPoints(body_rad);
  return {OrZero(twin.Slope("turntable.ez", at)), OrZero(twin.Slope("turntable.ex", at))};
}

/// The prediction of the twin where free unknowns put the mirror (Gauss-Newton).
/// @return slopes there.
Slopes FitTwin(const Followed& twin, TurntableRun& turntable) {
  constexpr int kMostRounds = 8;
  constexpr double kClose_rad = 1e-3 * arcsec;
  LinearRun& run = turntable.run;
  const Eigen::Index readings = run.schedule.Readings();
  const NoiseModel noise{run.sigma, {}};
  // What the mirror does for each unknown, and what is shown of that.
  const Nuisance moved = FreeUnknowns(turntable.places, StraightSlopes(readings), run.schedule);
  Eigen::VectorXd unknowns = Eigen::VectorXd::Zero(moved.jacobian.cols());
  turntable.body_rad = Eigen::MatrixXd::Zero(readings, kAxes);
  for (int round = 0;; ++round) {
    const Slopes slopes = SlopesAt(twin, turntable.body_rad);
    run.residual = OrZero(run.observed - AsRows(twin.Predict(AtPoints(turntable.body_rad))));
    if (round == kMostRounds) return slopes;
    const Nuisance free = FreeUnknowns(turntable.places, slopes, run.schedule);
    const Projector projector(noise.Whiten(run, free.jacobian), free);
    const Eigen::VectorXd before = run.residual + free.jacobian * unknowns;
    unknowns = projector.Solve(noise.Whiten(run, Eigen::MatrixXd(before))).col(0);
    const Eigen::MatrixXd next_rad = ByReading(moved.jacobian * unknowns);
    const double step_rad = (next_rad - turntable.body_rad).cwiseAbs().maxCoeff();
    turntable.body_rad = next_rad;
    if (step_rad > kClose_rad) continue;
    run.residual = OrZero(run.observed - AsRows(twin.Predict(AtPoints(next_rad))));
    return slopes;
  }
}

/// True of an effect that is added behind the optics: a moving zero, a ripple.
bool IsAddedBehind(const EffectSettings& effect) {
  constexpr std::array kBehind = {"autocollimator_drift", "mount_creep", "slip", "tone", "autocollimator_periodic"};
  return std::ranges::count(kBehind, effect.name) > 0;
}

/// The scenario without what is added behind the optics: on what they show, errors of the reading depend.
Scenario BeforeAdding(Scenario scenario) {
  scenario.empiricals.clear();
  std::erase_if(scenario.effects, [](const EffectSettings& e) { return IsAddedBehind(e); });
  return scenario;
}

/// Standard uncertainty of each row: everything that is drawn anew at a stop, as the twin shows it.
Eigen::VectorXd Sigma_rad(const Followed& twin, const Eigen::MatrixXd& body_rad, const Scenario& scenario) {
  constexpr std::array<const char*, kComponents> kNames = {"ex", "ey", "ez", "dx", "dy", "dz"};
  const double noise_rad = TurntableOf(scenario).ReadingNoise_rad();
  Eigen::MatrixXd variance = Eigen::MatrixXd::Constant(body_rad.rows(), kAxes, noise_rad * noise_rad);
  const auto add = [&](const std::string& point, double sd) {
    if (sd > 0.0) variance += (sd * OrZero(twin.Slope(point, AtPoints(body_rad)))).cwiseAbs2();
  };
  for (std::size_t c = 0; c < kComponents; ++c) {
    add(std::string("turntable.") + kNames[c], TurntableOf(scenario).turntable.repeatability_sd[c]);
    add(std::string("multitooth.") + kNames[c], TurntableOf(scenario).multitooth_table.repeatability_sd[c]);
  }
  add("multitooth.ez", SeatingEffect_rad(scenario));
  add("turntable.yaw", EncoderScatter_rad(TurntableOf(scenario)));
  add("room.temperature", scenario.environment.sensor_noise_K);
  return AsRows(variance.cwiseSqrt()).cwiseMax(kLeastNoise_rad);
}

/// Readings that are told by the twin as it follows the record.
void FollowTwin(const std::vector<Reading>& readings, const std::vector<Reading>& used, const Scenario& scenario,
                const model::FollowMaker& follow, TurntableRun& turntable) {
  LinearRun& run = turntable.run;
  const Followed twin(follow, scenario, readings, used);
  run.sigma = Sigma_rad(twin, Eigen::MatrixXd::Zero(run.schedule.Readings(), kAxes), scenario);
  const Slopes slopes = FitTwin(twin, turntable);
  const Eigen::MatrixXd shown_rad = twin.Predict(AtPoints(turntable.body_rad));
  run.sigma = Sigma_rad(twin, turntable.body_rad, scenario);
  turntable.is_shown = AsRows(shown_rad).array().isFinite();
  run.sigma = turntable.is_shown.select(run.sigma, kNoWeight * run.sigma);
  ScaleToMean(used, run);
  const bool nothing_behind = scenario.empiricals.empty() && std::ranges::none_of(scenario.effects, IsAddedBehind);
  turntable.context.shown_rad =
      OrZero(nothing_behind
                 ? shown_rad
                 : Followed(follow, BeforeAdding(scenario), readings, used).Predict(AtPoints(turntable.body_rad)));
  // A face is nulled: what the prediction shows of x beside zero is the encoder's scatter, which is in what is left
  // of x as well, and would look like an error that goes with x.
  if (TurntableOf(scenario).HasPolygon()) turntable.context.shown_rad.col(kX).setZero();
  run.nuisance = AllUnknowns(turntable.places, slopes, turntable.context, scenario,
                             OrZero(twin.Slope("room.temperature", AtPoints(turntable.body_rad))));
}

/// What the run's twin does not show is no reading of the comparison; what another's alone does not show is not known.
Eigen::VectorXd LeftWhereShown(const Eigen::VectorXd& observed, const Eigen::VectorXd& shown, const Eigen::ArrayX<bool>& compared) {
  return compared.select(observed - shown, 0.0);
}

/// The mirror moves as the free unknowns say; all others (the standard's, the room's) are small and act by their slopes.
diagnose::LeftByAnother LeftByAnotherOf(const std::vector<Reading>& readings, const std::vector<Reading>& used,
                                        const model::FollowMaker& follow, const TurntableRun& turntable) {
  struct Asked {
    std::vector<Reading> readings, used;
    Nuisance moved, free;
    Eigen::VectorXd observed;
    Eigen::MatrixXd body_rad;
    Eigen::ArrayX<bool> compared;  // the run's own twin shows it
  };
  const LinearRun& run = turntable.run;
  auto asked = std::make_shared<Asked>(Asked{readings, used,
                                             FreeUnknowns(turntable.places, StraightSlopes(run.schedule.Readings()), run.schedule),
                                             run.nuisance, run.observed, turntable.body_rad,
                                             turntable.is_shown});
  return [asked, follow](const Scenario& other) -> LeftWhere {
    const auto twin = std::make_shared<const Followed>(follow, other, asked->readings, asked->used);
    return [asked, twin](const Eigen::VectorXd& by) -> Eigen::VectorXd {
      const Eigen::Index mirror = asked->moved.jacobian.cols();
      const Eigen::VectorXd of_mirror = by.head(mirror);
      const Eigen::MatrixXd body_rad = asked->body_rad + ByReading(asked->moved.jacobian * of_mirror);
      return LeftWhereShown(asked->observed, AsRows(twin->Predict(AtPoints(body_rad))), asked->compared) +
             asked->free.jacobian.leftCols(mirror) * of_mirror;
    };
  };
}

double StandardDeviation(const Eigen::VectorXd& values) {
  return std::sqrt((values.array() - values.mean()).square().mean());
}

}  // namespace

TurntableRun BuildRun(const std::vector<Reading>& readings, const Scenario& scenario,
                      const model::FollowMaker& follow) {
  const std::vector<Reading> used = Usable(readings);
  TurntableRun turntable;
  turntable.left_out = static_cast<int>(std::ssize(readings) - std::ssize(used));
  LinearRun& run = turntable.run;
  run.bench = scenario.bench;
  run.schedule = model::CourseOf(used);
  turntable.places = PlacesOf(AtNominal(run.schedule, TurntableOf(scenario)));
  turntable.context = ContextOf(run.schedule, scenario);
  run.channels = {kAxisNames.begin(), kAxisNames.end()};
  run.unit = "arcsec";
  run.to_SI = arcsec;
  run.noise_free = scenario.noise_free;
  run.observed = AsRows(AsRead_rad(used));
  FollowTwin(readings, used, scenario, follow, turntable);
  run.left_by_another = LeftByAnotherOf(readings, used, follow, turntable);
  return turntable;
}

TurntableRun LinearisedAbout(const std::vector<EffectSettings>& found, const std::vector<Reading>& readings,
                             const Scenario& scenario, const model::FollowMaker& follow) {
  Scenario with_found = scenario;
  with_found.effects.insert(with_found.effects.end(), found.begin(), found.end());
  TurntableRun turntable = BuildRun(readings, with_found, follow);
  const Followed stated(follow, scenario, readings, Usable(readings));
  turntable.run.residual = OrZero(turntable.run.observed - AsRows(stated.Predict(AtPoints(turntable.body_rad))));
  return turntable;
}

std::string BiasInWords(const Places& places, const Eigen::VectorXd& unknowns) {
  if (places.circle_blocks == 0) return "no error of the turntable";
  Eigen::VectorXd index(places.circle_blocks), tilt(places.circle_blocks);
  for (int b = 0; b < places.circle_blocks; ++b) {
    index[b] = unknowns[kAxes * b + kX];
    tilt[b] = unknowns[kAxes * b + kY];
  }
  const double index_arcsec = StandardDeviation(index) / arcsec, tilt_arcsec = StandardDeviation(tilt) / arcsec;
  if (std::max(index_arcsec, tilt_arcsec) < 1e-6) return "no error of the turntable";
  if (index_arcsec >= tilt_arcsec) return fmt::format("turntable ez up to {:.2g} arcsec rms", index_arcsec);
  return fmt::format("turntable tilt up to {:.2g} arcsec rms", tilt_arcsec);
}

}  // namespace twinbench::diagnose::turntable
