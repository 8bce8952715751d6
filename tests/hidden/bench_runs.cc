#include "tests/hidden/bench_runs.h"

#include <cmath>

#include "tests/support/twin_run.h"
#include "twin/core/errors.h"

namespace twinbench::hidden {
namespace {

using units::arcsec;
using units::um;

void StateAllOfTheDevice(Scenario& scenario) {
  scenario.device.lines = 30;
  scenario.device.teeth = 22;
  scenario.encoder_procedure.mounting_rad = {0.0, 0.5 * units::kPi};
}

void DrawTables(Stream& stream, Scenario& scenario) {
  for (TableSettings* table : {&scenario.target, &scenario.reference}) {
    const double size = UniformIn(stream, 0.6, 1.5);
    for (double& rms : table->random_rms) rms *= size;
  }
  scenario.centring_m = {UniformIn(stream, -5.0, 5.0) * um, UniformIn(stream, -5.0, 5.0) * um};
  scenario.mount_tilt_rad = {UniformIn(stream, -20.0, 20.0) * arcsec, UniformIn(stream, -20.0, 20.0) * arcsec};
}

void DrawRoom(Stream& stream, EnvironmentSettings& room) {
  room.temperature_degC = room.reference_degC + UniformIn(stream, -0.3, 0.3);
  room.drift_K_h = UniformIn(stream, -0.3, 0.3);
  room.swing_K = UniformIn(stream, 0.1, 0.3);
  room.swing_period_s = UniformIn(stream, 1800.0, 5400.0);
  room.random_walk_K_sqrt_h = UniformIn(stream, 0.0, 0.1);
}

/// What the readings show, by row of the run, SI.
double Shown(const Reading& reading, int channel, int channels, const Scenario& scenario) {
  if (channels == 1) return reading.measured_rad;
  const PsdSettings& psd = channel < 2 ? scenario.psd_a : scenario.psd_b;
  return reading.mean_V[static_cast<std::size_t>(channel)] / psd.sensitivity_V_m;
}

}  // namespace

double UniformIn(Stream& stream, double lower, double upper) {
  return lower + (upper - lower) * stream.Uniform();
}

double LogUniformIn(Stream& stream, double lower, double upper) {
  return lower * std::pow(upper / lower, stream.Uniform());
}

Scenario Believed(Design design) {
  const bool rotary = design == Design::kRotary;
  Scenario scenario = LoadScenario(test::ScenarioPath(rotary ? "rotary_4dof.toml" : "encoder_comparison.toml"));
  scenario.adc.every_sample = false;
  if (design == Design::kSweep || design == Design::kSweepAllKnown) scenario.encoder_procedure.kind = "sweep";
  // Two set-ups have twice the readings; half as many a second keep a case as quick as the others.
  if (design == Design::kSweepAllKnown) scenario.encoder_procedure.interval_s *= 2.0;
  if (design == Design::kStopsAllKnown || design == Design::kSweepAllKnown) StateAllOfTheDevice(scenario);
  return scenario;
}

Scenario Drawn(Design design, std::uint64_t seed) {
  Scenario scenario = Believed(design);
  scenario.seed = seed;
  Stream stream(seed, "hidden.bench");
  if (design != Design::kRotary) return scenario;
  DrawTables(stream, scenario);
  DrawRoom(stream, scenario.environment);
  return scenario;
}

std::vector<Reading> TakeReadings(const Scenario& actual) {
  return actual.bench == kRotaryBench ? test::RunTwin(actual).readings : test::RunEncoderTwin(actual).readings;
}

SignatureScale::SignatureScale(Design design, const std::string& cache_folder) {
  diagnose::DiagnoseOptions options;
  options.cache_folder = cache_folder;
  const diagnose::DiagnosisRun clean =
      diagnose::Diagnose(TakeReadings(Drawn(design, 1)), Believed(design), options);
  run_ = clean.run;
  noise_ = clean.noise;
  projector_ = std::make_unique<diagnose::Projector>(noise_.Whiten(run_, run_.nuisance.jacobian), run_.nuisance);
}

double SignatureScale::Rho(const std::vector<Reading>& with, const std::vector<Reading>& without) const {
  Require(with.size() == without.size(), "two runs of the same schedule");
  const Scenario bench = Believed(Design::kRotary);
  Eigen::MatrixXd signature(run_.Rows(), 1);
  for (int row = 0; row < run_.Rows(); ++row) {
    const int channel = run_.ChannelOf(row);
    const auto number =
        static_cast<std::size_t>(run_.schedule.reading[static_cast<std::size_t>(run_.ReadingOf(row))]);
    const double difference = Shown(with[number], channel, run_.Channels(), bench) -
                              Shown(without[number], channel, run_.Channels(), bench);
    signature(row, 0) = std::isfinite(difference) ? difference : 0.0;
  }
  const Eigen::MatrixXd white = noise_.Whiten(run_, signature);
  return std::sqrt(std::max(0.0, white.cwiseProduct(projector_->Apply(white)).sum()));
}

}  // namespace twinbench::hidden
