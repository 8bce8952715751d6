#include "twin/benches/encoder_comparison/diagnosis/encoder_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "twin/benches/encoder_comparison/axis_unit.h"
#include "twin/benches/encoder_comparison/diagnosis/few_counts.h"
#include "twin/benches/encoder_comparison/estimators/angle_comparison.h"
#include "twin/benches/encoder_comparison/settings.h"
#include "twin/core/distributions.h"
#include "twin/core/errors.h"
#include "twin/core/reading_clock.h"
#include "twin/core/units.h"
#include "twin/diagnose/engine/noise_estimate.h"
#include "twin/diagnose/engine/repeats.h"
#include "twin/diagnose/mean_of_runs.h"
#include "twin/diagnose/redundancy.h"
#include "twin/model/course.h"
#include "twin/model/motion.h"
#include "twin/model/signals.h"

namespace twinbench::diagnose::encoder {
namespace {

constexpr double kOffsetPrior_rad = 2.0 * units::kPi;  // free

std::vector<Reading> Chosen(const std::vector<Reading>& readings, const std::vector<int>& used) {
  std::vector<Reading> chosen;
  for (const int k : used) chosen.push_back(readings[static_cast<std::size_t>(k)]);
  return chosen;
}

/// Offsets of the set-ups: rows x set-ups.
Eigen::SparseMatrix<double, Eigen::RowMajor> SetUpIndicators(const std::vector<int>& setup) {
  std::map<int, int> column;
  for (const int s : setup) column.try_emplace(s, static_cast<int>(column.size()));
  Eigen::SparseMatrix<double, Eigen::RowMajor> indicators(std::ssize(setup), std::ssize(column));
  for (std::size_t i = 0; i < setup.size(); ++i) indicators.insert(static_cast<int>(i), column.at(setup[i])) = 1.0;
  return indicators;
}

/// Means by set-up, one entry a row.
Eigen::VectorXd SetUpMeans(const Eigen::SparseMatrix<double, Eigen::RowMajor>& indicators,
                           const Eigen::VectorXd& y) {
  const Eigen::VectorXd count = indicators.transpose() * Eigen::VectorXd::Ones(y.size());
  const Eigen::VectorXd sum = indicators.transpose() * y;
  return indicators * Eigen::VectorXd(sum.array() / count.array());
}

/// The device stands on the shaft as the readings say: what is locked to its angle must be where they show it.
Scenario AsMounted(Scenario scenario, const Schedule& s, const Eigen::VectorXd& offset_rad) {
  EncoderProcedureSettings& procedure = EncoderOf(scenario).encoder_procedure;
  procedure.heads_rad = {0.0};  // they are in the offsets
  std::vector<double>& mounting_rad = procedure.mounting_rad;
  for (int i = 0; i < s.Readings(); ++i) {
    const auto setup = static_cast<std::size_t>(std::max(0, s.setup[i]));
    if (setup >= mounting_rad.size()) mounting_rad.resize(setup + 1, 0.0);
    mounting_rad[setup] = offset_rad[i];
  }
  return scenario;
}

/// With the speeds that were derived, and without what the twin does not look at: the record is copied each time it
/// is followed.
std::vector<Reading> AsFollowed(std::vector<Reading> used, const Schedule& s) {
  for (std::size_t i = 0; i < used.size(); ++i) {
    used[i].velocity_rad_s = s.velocity_rad_s[static_cast<Eigen::Index>(i)];
    used[i].quantities.clear();
    used[i].extra.clear();
  }
  return used;
}

/// Of means of unlike many samples: deviation of each in units of that of the usual one.
Eigen::VectorXd RelativeNoise(const std::vector<Reading>& used) {
  std::vector<double> samples;
  for (const Reading& reading : used) samples.push_back(std::max(1, reading.n_samples));
  const double usual = Median(samples);
  return (usual / Eigen::Map<const Eigen::ArrayXd>(samples.data(), std::ssize(samples))).sqrt();
}

constexpr double kArithmetic_rad = 1e-12;  // less is rounding, where nothing else says what the noise is

/// By how much readings scatter from one to the next, all counted.
double Roughness_rad(const LinearRun& run) {
  double sum = 0.0, count = 0.0;
  for (Eigen::Index i = 2; i < run.residual.size(); ++i) {
    if (run.schedule.pass[static_cast<std::size_t>(i)] != run.schedule.pass[static_cast<std::size_t>(i - 2)])
      continue;
    sum += std::pow(run.residual[i] - 2.0 * run.residual[i - 1] + run.residual[i - 2], 2) / 6.0;
    count += 1.0;
  }
  return count > 0.0 ? std::sqrt(sum / count) : 0.0;
}

/// The device moves on while the reference shows the same: how far, on the average of such readings.
double WayWhileReferenceStands_rad(const LinearRun& run) {
  const Schedule& s = run.schedule;
  double way_rad = 0.0, count = 0.0;
  for (Eigen::Index i = 1; i < run.residual.size(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (s.reference_rad[i] != s.reference_rad[i - 1] || s.pass[at] != s.pass[at - 1]) continue;
    way_rad += s.direction[at] * (run.residual[i] - run.residual[i - 1]);
    count += 1.0;
  }
  return count > 0.0 ? way_rad / count : 0.0;
}

/// Angles of the reference that are rounded make an error in steps, and its differences are zero more often than
/// not: then their median says nothing.
/// @return that error where it is what the readings scatter by; 0 otherwise.
double RoundedReference_rad(const LinearRun& run, double noise_rad) {
  constexpr double kNothing = 0.01, kAlike = 2.0, kFine = 0.25;  // the last: of the way to the next reading
  constexpr double kGoesOn = 0.1, kWithin = 1.5;                 // of a step
  const double roughness_rad = Roughness_rad(run);
  const double step_rad = CommonStep(run.schedule.reference_rad), rounded_rad = step_rad / std::sqrt(12.0);
  const bool is_alike = rounded_rad > roughness_rad / kAlike && rounded_rad < roughness_rad * kAlike;
  const bool is_fine = step_rad < kFine * model::TypicalStep_rad(run.schedule, run.schedule.reference_rad);
  // Behind a command that goes by steps a device is off by a whole one, to either side.
  const bool is_within = run.residual.maxCoeff() - run.residual.minCoeff() < kWithin * step_rad;
  const bool goes_on = is_within && WayWhileReferenceStands_rad(run) > kGoesOn * step_rad;
  return is_alike && (goes_on || (is_fine && noise_rad < kNothing * roughness_rad)) ? rounded_rad : 0.0;
}

/// Readings that are rounded err by no less than that, and all by the arithmetic of many turns. Where one is the
/// mean of several, only what rounding repeats in all of them is left of it.
void SetNoise(LinearRun& run, const EncoderSettings& bench, const std::vector<Reading>& used) {
  Eigen::VectorXd shown_rad(std::ssize(used));
  for (std::size_t i = 0; i < used.size(); ++i) shown_rad[static_cast<Eigen::Index>(i)] = used[i].measured_rad;
  const double step_rad =
      std::max({bench.device.resolution_rad, RunsIn(used) * CommonStep(shown_rad), CountOfFewValues(shown_rad)});
  run.sigma_stated = bench.device.noise_known && bench.device.noise_rad > 0.0;
  const Eigen::VectorXd relative = RelativeNoise(used);
  const double count = bench.encoder_procedure.ReadingsAtOnce();
  double noise_rad = run.sigma_stated
                         ? DeviceOfMeans(bench).noise_rad
                         : std::max(EstimateNoise_rad(run.schedule, run.residual, relative), kArithmetic_rad);
  const double of_reference_rad = run.sigma_stated ? 0.0 : RoundedReference_rad(run, noise_rad);
  noise_rad = std::max(noise_rad, of_reference_rad);
  const RoundingInMean rounding_rad2 = RoundingOf(step_rad, std::sqrt(count) * noise_rad, count);
  run.rounding = std::sqrt(12.0 * std::max(rounding_rad2.repeated, of_reference_rad * of_reference_rad));
  const double rounded_rad = std::sqrt(rounding_rad2.all);
  const auto and_rounding = [=](double own_rad) { return std::hypot(own_rad, rounded_rad); };
  run.sigma = relative * noise_rad;
  run.sigma = run.sigma_stated ? run.sigma.unaryExpr(and_rounding).eval() : run.sigma.cwiseMax(rounded_rad).eval();
  ScaleToMean(used, run);
}

}  // namespace

Nuisance EncoderRun::SetUpsAlone() const {
  Nuisance nuisance;
  nuisance.jacobian = setups;
  nuisance.prior_precision = Eigen::VectorXd::Constant(setups.cols(), 1.0 / (kOffsetPrior_rad * kOffsetPrior_rad));
  return nuisance;
}

Eigen::VectorXd EncoderRun::BesideSetUps(const Eigen::VectorXd& rows) const {
  return rows - SetUpMeans(setups, rows);
}

ErrorOfTwin FollowTwin(const EncoderRun& encoder, const Scenario& scenario, const model::FollowMaker& follow,
                       const Eigen::VectorXd& offset_rad, double same_rad) {
  // What is locked to the device's angle turns with it: each step leaves a tenth of what is wrong, or less.
  constexpr int kSteps = 6;
  const Schedule& s = encoder.run.schedule;
  ErrorOfTwin followed{{}, offset_rad};
  for (int step = 0; step < kSteps; ++step) {
    followed.error_rad =
        follow(AsMounted(scenario, s, followed.offset_rad), encoder.used)->Predict().col(0) - s.reference_rad;
    const Eigen::VectorXd mean_rad = SetUpMeans(encoder.setups, encoder.error_rad - followed.error_rad);
    if (mean_rad.cwiseAbs().maxCoeff() < same_rad) break;
    if (step + 1 < kSteps) followed.offset_rad += mean_rad;
  }
  return followed;
}

EncoderRun BuildRun(const std::vector<Reading>& readings, const Scenario& scenario,
                    const model::FollowMaker& follow) {
  const measure::AngleComparison comparison = measure::CompareAngles(readings);
  RefuseTooFew(comparison.used.size(), readings.size());
  EncoderRun encoder;
  encoder.left_out = comparison.left_out;
  LinearRun& run = encoder.run;
  run.bench = scenario.bench;
  const std::vector<Reading> used = Chosen(readings, comparison.used);
  run.schedule = model::CourseOf(used);
  const bool is_recorded = run.schedule.velocity_rad_s.array().isFinite().any();
  if (EncoderOf(scenario).encoder_procedure.kind == "sweep" && !is_recorded)
    run.schedule.velocity_rad_s = model::RateOfChange(run.schedule, run.schedule.reference_rad);
  run.channels = {"angle"};
  const benches::encoder::AxisUnit told_in = benches::encoder::CoarseUnit(EncoderOf(scenario).device);
  run.unit = told_in.name;
  run.to_SI = told_in.to_SI;
  run.patterns = {{"angle", Eigen::VectorXd::Ones(1)}};
  encoder.setups = SetUpIndicators(run.schedule.setup);
  run.nuisance = encoder.SetUpsAlone();
  run.residual = encoder.error_rad = comparison.error_rad;
  run.observed = run.schedule.reference_rad + comparison.error_rad;
  encoder.glitches = FindGlitches(run, RelativeNoise(used));
  Bridge(encoder.glitches, encoder.error_rad);
  Bridge(encoder.glitches, run.observed);
  encoder.used = AsFollowed(used, run.schedule);
  encoder.offset_rad = SetUpMeans(encoder.setups, encoder.error_rad);
  const ErrorOfTwin followed = FollowTwin(encoder, scenario, follow, encoder.offset_rad);
  encoder.offset_rad = followed.offset_rad;
  run.residual = encoder.error_rad - followed.error_rad;
  run.residual -= SetUpMeans(encoder.setups, run.residual);
  if (run.residual.cwiseAbs().maxCoeff() < kArithmetic_rad) run.residual.setZero();
  encoder.context =
      ContextOf(run.schedule, run.schedule.reference_rad + encoder.offset_rad, EncoderOf(scenario).device);
  encoder.context.has_clock = HasClock(used);
  encoder.context.has_means = encoder.context.Moves() && used[used.size() / 2].n_samples > 1;
  if (model::HasTemperature(run.schedule))
    encoder.context.above_K = model::Above_K(run.schedule, scenario.environment.reference_degC);
  run.place = PlacesOf(encoder.context.device_rad, run.schedule.setup);
  SetNoise(run, EncoderOf(scenario), used);
  return encoder;
}

}  // namespace twinbench::diagnose::encoder
