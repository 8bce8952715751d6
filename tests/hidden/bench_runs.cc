#include "tests/hidden/twin_cases.h"

#include "tests/support/angle_benches.h"
#include "twin/benches/circular_motion/columns.h"
#include "twin/benches/freeform_five_axis/columns.h"
#include "twin/benches/hob_transmission/bench.h"
#include "twin/benches/turntable_autocollimator/bench.h"
#include "twin/core/errors.h"

namespace twinbench::hidden {
namespace {

using units::arcsec, units::um;

void DrawTables(Stream& stream, Scenario& scenario) {
  for (TableSettings* table : {&RotaryOf(scenario).target, &RotaryOf(scenario).reference}) {
    const double size = UniformIn(stream, 0.6, 1.5);
    for (double& rms : table->random_rms) rms *= size;
  }
  RotaryOf(scenario).centring_m = {UniformIn(stream, -5.0, 5.0) * um, UniformIn(stream, -5.0, 5.0) * um};
  RotaryOf(scenario).mount_tilt_rad = {UniformIn(stream, -20.0, 20.0) * arcsec,
                                       UniformIn(stream, -20.0, 20.0) * arcsec};
}

void DrawRoom(Stream& stream, EnvironmentSettings& room) {
  room.temperature_degC = room.reference_degC + UniformIn(stream, -0.3, 0.3);
  room.drift_K_h = UniformIn(stream, -0.3, 0.3);
  room.swing_K = UniformIn(stream, 0.1, 0.3);
  room.swing_period_s = UniformIn(stream, 1800.0, 5400.0);
  room.random_walk_K_sqrt_h = UniformIn(stream, 0.0, 0.1);
}

/// What a reading shows on its channels, and how much that is of one SI unit. Of circles it is not a field each.
struct Shows {
  std::vector<double*> channels;
  double of_unit = 1.0;
};

Shows ShownBy(const std::string& bench, Reading& r) {
  using namespace benches::freeform;
  if (bench == kRotaryBench) return {{&r.mean_V[0], &r.mean_V[1], &r.mean_V[2], &r.mean_V[3]}, kSensitivity_V_m};
  if (bench == kTurntableBench) return {{&r.autocollimator_yaw_rad, &r.autocollimator_tilt_rad}};
  if (bench == kFreeformBench) return {{&kQpdX_V(r), &kQpdY_V(r), &kCcd_px(r)}};
  return {{&r.measured_rad}};
}

double Shown(const std::string& bench, Reading& r, int channel) {
  if (bench == kCircularBench) {
    const benches::circular::Deviation shown = benches::circular::DeviationOf(r);
    return channel == 0 ? shown.radial_m : shown.tangential_m;
  }
  const Shows shows = ShownBy(bench, r);
  return *shows.channels[static_cast<std::size_t>(channel)] / shows.of_unit;
}

void AddToCircle(const Eigen::RowVectorXd& values, Reading& r) {
  using namespace benches::circular;
  if (IsOfBar(r)) {
    kBar_m(r) += values[0];
    kEncoder_rad(r) += values[1] / Radius_m(r);
    return;
  }
  const double c = std::cos(r.target_rad), s = std::sin(r.target_rad);
  kGridX_m(r) += c * values[0] - s * values[1];
  kGridY_m(r) += s * values[0] + c * values[1];
}

void DrawTurntable(Stream& stream, Scenario& scenario) {
  TableSettings& turntable = TurntableOf(scenario).turntable;
  for (HarmonicSettings& h : turntable.harmonics) {
    h.amplitude *= UniformIn(stream, 0.6, 1.5);
    h.phase_rad = UniformIn(stream, 0.0, 2.0 * units::kPi);
  }
  turntable.random_rms[static_cast<std::size_t>(Component::kEz)] = UniformIn(stream, 0.2, 0.6) * arcsec;
  for (const Component c : {Component::kEx, Component::kEy})
    turntable.random_rms[static_cast<std::size_t>(c)] = UniformIn(stream, 0.5, 2.0) * arcsec;
}

/// What an evaluation takes as unknown: the transmission's lowest orders.
void DrawTransmission(Stream& stream, Scenario& scenario) {
  for (HarmonicSettings& h : HobOf(scenario).transmission.harmonics) {
    const double factor = UniformIn(stream, 0.5, 1.5), phase_rad = UniformIn(stream, 0.0, 2.0 * units::kPi);
    if (h.order > HobOf(scenario).transmission.free_orders) continue;
    h.amplitude *= factor;
    h.phase_rad = phase_rad;
  }
}

}  // namespace

const DesignNames& NamesOf(Design design) {
  static const std::vector<std::string> warm = {"environment.swing_mK=700.0", "environment.swing_period_s=7000.0"};
  static const std::string sweep = "encoder_procedure.kind=sweep", lines = "device.lines_per_turn=30",
                           teeth = "device.teeth=22", mountings = "encoder_procedure.mounting_deg=[0.0, 90.0]";
  static const std::vector<DesignNames> names = {
      // Two thirds of the stops, which tell everything apart.
      {"rotary", kRotaryBench,
       {"mechanics.fidelity=kinematic", "procedure.positions=24", "procedure.shifts=[0, 1, 5, 8]",
        "adc.every_sample=false"}},
      {"stops", kEncoderBench, {}},
      {"sweep", kEncoderBench, {sweep}},
      {"stops+", kEncoderBench, {lines, teeth, mountings}},
      // Two set-ups have twice the readings; half as many a second keep a case as quick as the others.
      {"sweep+", kEncoderBench, {lines, teeth, mountings, sweep, "encoder_procedure.interval_s=0.16"}},
      {"turntable", kTurntableBench,
       {"turntable_procedure.phases=[\"calibration\", \"full_circle\"]", "turntable_procedure.positions=36",
        "turntable_procedure.passes=[1, -1, -1, 1]", "turntable_procedure.eccentricities_um=[50.0, 1500.0]",
        "turntable_procedure.dwell_s=[0.5, 2.0, 5.0]"}},
      {"hob", kHobBench,
       {"interferometer.noise_arcsec=0.3",  // else it decides at sizes where second orders matter
        "mechanics.fidelity=kinematic", "hob_procedure.hob_speeds_rev_min=[50.0, 25.0]", "hob_procedure.turns=1",
        "hob_procedure.samples_per_turn=360", "hob_procedure.poll_s=10.0"}},
      {"circles", kCircularBench,
       {"circular_procedure.points=72", "circular_procedure.stops=18", warm[0], warm[1]}},
      {"freeform", kFreeformBench, {"freeform_procedure.poses=40", "optics.fidelity=closed", warm[0], warm[1]}},
      {"warm stops", kEncoderBench, {warm[0], "environment.swing_period_s=2000.0"}}};
  return names[static_cast<std::size_t>(design)];
}

double UniformIn(Stream& stream, double lower, double upper) { return lower + (upper - lower) * stream.Uniform(); }

double LogUniformIn(Stream& stream, double lower, double upper) {
  return lower * std::pow(upper / lower, stream.Uniform());
}

Scenario Believed(Design design) {
  return LoadScenario(test::ScenarioPath(BenchOf(design) + ".toml"), NamesOf(design).keys);
}

Scenario Drawn(Design design, std::uint64_t seed) {
  Scenario scenario = Believed(design);
  scenario.seed = seed;
  Stream stream(seed, "hidden.bench");
  if (design == Design::kRotary) DrawTables(stream, scenario);
  if (design == Design::kTurntable) DrawTurntable(stream, scenario);
  if (design == Design::kHob) DrawTransmission(stream, scenario);
  if (design == Design::kRotary || design == Design::kTurntable) DrawRoom(stream, scenario.environment);
  return scenario;
}

std::vector<Reading> TakeReadings(const Scenario& actual) { return test::ReadingsOf(actual); }

void AddTo(const std::string& bench, const Eigen::MatrixXd& signal, std::vector<Reading>& readings) {
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const Eigen::RowVectorXd values = signal.row(static_cast<Eigen::Index>(i));
    if (bench == kCircularBench) {
      AddToCircle(values, readings[i]);
      continue;
    }
    const Shows shows = ShownBy(bench, readings[i]);
    for (std::size_t c = 0; c < shows.channels.size(); ++c)
      *shows.channels[c] += shows.of_unit * values[static_cast<Eigen::Index>(c)];
  }
}

const SignatureScale::Clean& SignatureScale::CleanRun(std::uint64_t seed) const {
  const std::uint64_t schedule = design_ == Design::kFreeform ? seed : 1;
  const std::scoped_lock lock(one_at_a_time_);
  Clean& clean = clean_[schedule];
  if (clean.projector) return clean;
  const Bench& bench = BenchNamed(BenchOf(design_));
  clean.run = bench.linear_run(TakeReadings(Drawn(design_, schedule)), Believed(design_), Estimator::kRigorous);
  clean.noise = {clean.run.sigma, {}};
  clean.projector = std::make_unique<diagnose::Projector>(
      clean.noise.Whiten(clean.run, clean.run.nuisance.jacobian), clean.run.nuisance);
  return clean;
}

/// What the readings show in the rows of the run.
Eigen::VectorXd SignatureScale::Rows(std::vector<Reading> readings, const diagnose::LinearRun& clean) const {
  if (design_ == Design::kTurntable)
    return benches::turntable::Linear(readings, Believed(design_), Estimator::kRigorous).observed;
  if (design_ == Design::kHob)
    return benches::hob::Linear(readings, Believed(design_), Estimator::kRigorous).observed;
  Eigen::VectorXd rows(clean.Rows());
  for (int row = 0; row < clean.Rows(); ++row) {
    const auto number =
        static_cast<std::size_t>(clean.schedule.reading[static_cast<std::size_t>(clean.ReadingOf(row))]);
    rows[row] = Shown(BenchOf(design_), readings[number], clean.ChannelOf(row));
  }
  return rows;
}

double SignatureScale::Rho(const std::vector<Reading>& with, const std::vector<Reading>& without,
                           std::uint64_t seed) const {
  Require(with.size() == without.size(), "two runs of the same schedule");
  const Clean& clean = CleanRun(seed);
  Eigen::MatrixXd signature = Rows(with, clean.run) - Rows(without, clean.run);
  Require(signature.rows() == clean.run.Rows(), "a run of the design");
  signature = signature.array().isFinite().select(signature, 0.0);
  const Eigen::MatrixXd white = clean.noise.Whiten(clean.run, signature);
  return std::sqrt(std::max(0.0, white.cwiseProduct(clean.projector->Apply(white)).sum()));
}

const SignatureScale& ScaleOf(Design design) {
  static std::mutex one_at_a_time;
  static std::map<Design, SignatureScale> scales;
  const std::scoped_lock lock(one_at_a_time);
  return scales.try_emplace(design, design).first->second;
}

}  // namespace twinbench::hidden
