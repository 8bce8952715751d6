#include "tests/diagnose/support/synthetic_run.h"

#include <numeric>

#include "twin/benches/names.h"
#include "twin/core/stream.h"
#include "twin/core/units.h"

namespace twinbench::diagnose {
namespace {

constexpr double kWeak = 1e-3;  // prior deviation of free unknowns, m: thousands of times the noise

struct Stop {
  int setup, pass, direction, position;
  Phase phase = Phase::kFullCircle;
};

std::vector<Stop> StopsOf(const SyntheticDesign& design) {
  std::vector<Stop> stops(static_cast<std::size_t>(design.calibration), {0, 0, 1, 0, Phase::kCalibration});
  int pass = 0;
  for (int setup = 0; setup < static_cast<int>(design.shifts.size()); ++setup) {
    for (int direction : design.passes) {
      for (int k = 0; k < design.positions; ++k) {
        stops.push_back({setup, pass, direction, direction > 0 ? k : design.positions - 1 - k});
      }
      ++pass;
    }
  }
  return stops;
}

/// In steps from the reference's zero.
int ReferenceAt(const SyntheticDesign& design, const Stop& stop) {
  if (stop.phase == Phase::kCalibration) return 0;
  return design.shifts[static_cast<std::size_t>(stop.setup)] - stop.position;
}

Schedule ScheduleOf(const SyntheticDesign& design) {
  constexpr std::array<double, 4> kDwells_s = {0.5, 1.0, 2.0, 4.0};
  const std::vector<Stop> stops = StopsOf(design);
  Stream stream(7, "synthetic.schedule");
  Schedule s = PlainSchedule(static_cast<int>(stops.size()));
  const double step_rad = 2.0 * units::kPi / design.positions;
  for (std::size_t k = 0; k < stops.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    const auto [setup, pass, direction, position, phase] = stops[k];
    s.setup[k] = setup, s.pass[k] = pass, s.direction[k] = direction, s.position[k] = position, s.phase[k] = phase;
    s.dwell_s[i] = kDwells_s[stream.Word() % 4];
    s.time_s[i] = (i > 0 ? s.time_s[i - 1] : 0.0) + 6.0 + s.dwell_s[i] + (k % 48 == 0 ? 120.0 : 0.0);
    s.temperature_degC[i] = 20.0 + 0.5 * std::sin(s.time_s[i] / 170.0) + 0.3 * std::sin(s.time_s[i] / 61.0);
    s.target_rad[i] = position * step_rad;
    s.reference_rad[i] = ReferenceAt(design, stops[k]) * step_rad;
  }
  return s;
}

/// Local unknowns: the channels at one target position. Core: the same by reference position, then by set-up, then those
/// of the calibration.
Nuisance NuisanceOf(const SyntheticDesign& design) {
  const int n = design.positions, axes = design.channels, tables = design.free_tables ? 2 * n : 0;
  const int setups = static_cast<int>(design.shifts.size());
  const int unknowns = axes * (tables + setups + (design.calibration > 0 ? 1 : 0));
  const std::vector<Stop> stops = StopsOf(design);
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < std::ssize(stops); ++i) {
    const Stop& stop = stops[static_cast<std::size_t>(i)];
    const bool is_calibration = stop.phase == Phase::kCalibration;
    const int constant = is_calibration ? setups : stop.setup;
    const int reference = (ReferenceAt(design, stop) % n + n) % n;
    for (int c = 0; c < axes; ++c) {
      entries.emplace_back(i * axes + c, (tables + constant) * axes + c, 1.0);
      if (!design.free_tables || is_calibration) continue;
      entries.emplace_back(i * axes + c, stop.position * axes + c, 1.0);
      entries.emplace_back(i * axes + c, (n + reference) * axes + c, 1.0);
    }
  }
  Nuisance nuisance;
  nuisance.jacobian.resize(std::ssize(stops) * axes, unknowns);
  nuisance.jacobian.setFromTriplets(entries.begin(), entries.end());
  nuisance.prior_precision = Eigen::VectorXd::Constant(unknowns, 1.0 / (kWeak * kWeak));
  nuisance.blocks = design.free_tables ? n : 0;
  nuisance.block_size = design.free_tables ? axes : 0;
  return nuisance;
}

std::vector<Pattern> RotaryPatterns() {
  return {{"yaw", 0.2 * Eigen::Vector4d(1, 0, 1, 0)},
          {"tilt", 0.2 * Eigen::Vector4d(0, 1, 0, 1)},
          {"roll", 0.04 * Eigen::Vector4d(0, 1, 0, -1)},
          {"lateral", 0.42 * Eigen::Vector4d(1, 0, -1, 0)}};
}

}  // namespace

Schedule PlainSchedule(int readings) {
  Schedule s;
  const auto n = static_cast<std::size_t>(readings);
  s.reading.resize(n), s.setup.assign(n, 0), s.pass.assign(n, 0), s.direction.assign(n, 1);
  std::iota(s.reading.begin(), s.reading.end(), 0);
  s.position = s.reading;
  s.phase.assign(n, Phase::kFullCircle);
  for (Eigen::VectorXd* v :
       {&s.time_s, &s.dwell_s, &s.temperature_degC, &s.target_rad, &s.reference_rad, &s.velocity_rad_s})
    v->setConstant(readings, kNaN);
  return s;
}

LinearRun SyntheticRun(const SyntheticDesign& design) {
  LinearRun run;
  run.bench = kRotaryBench;
  run.schedule = ScheduleOf(design);
  run.channels = {"psd_a_x", "psd_a_y", "psd_b_x", "psd_b_y"};
  run.unit = "um";
  run.to_SI = units::um;
  const int rows = run.schedule.Readings() * design.channels;
  Stream stream(7, "synthetic.spots");
  run.observed.resize(rows);
  for (double& u : run.observed) u = 300.0 * units::um * (stream.Uniform() - 0.5);
  run.residual = Eigen::VectorXd::Zero(rows);
  run.sigma = Eigen::VectorXd::Constant(rows, design.sigma_m);
  run.nuisance = NuisanceOf(design);
  run.patterns = RotaryPatterns();
  return run;
}

Eigen::MatrixXd RandomMatrix(const std::string& name, Eigen::Index rows, Eigen::Index columns) {
  Stream stream(5, name);
  Eigen::MatrixXd m(rows, columns);
  for (double& v : m.reshaped()) v = stream.Normal();
  return m;
}

Projector ProjectorOf(const LinearRun& run, const NoiseModel& noise) {
  return {noise.Whiten(run, run.nuisance.jacobian), run.nuisance};
}

void AddNoise(LinearRun& run, std::uint64_t seed) {
  Stream stream(seed, "synthetic.noise");
  for (int k = 0; k < run.Rows(); ++k) {
    const double noise = run.sigma[k] * stream.Normal();
    run.residual[k] += noise;
    run.observed[k] += noise;
  }
}

void AddEffect(LinearRun& run, const Eigen::VectorXd& weight, const std::function<double(int)>& f) {
  for (int k = 0; k < run.Rows(); ++k) {
    const double effect = weight[run.ChannelOf(k)] * f(run.ReadingOf(k));
    run.residual[k] += effect;
    run.observed[k] += effect;
  }
}

LinearRun SyntheticSweep(int readings) {
  LinearRun run;
  Schedule& s = run.schedule = PlainSchedule(readings);
  const int sweep = readings / 4;
  for (int i = 0; i < readings; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const int which = std::min(3, i / sweep);
    s.pass[k] = which;
    s.direction[k] = which % 2 == 0 ? 1 : -1;
    s.time_s[i] = 0.1 * i;
    s.velocity_rad_s[i] = s.direction[k] * (which < 2 ? 0.1 : 0.3);
    s.reference_rad[i] = i == 0 ? 0.0 : s.reference_rad[i - 1] + 0.1 * s.velocity_rad_s[i];
  }
  run.bench = kEncoderBench;
  run.channels = {"angle"};
  run.unit = "arcsec";
  run.to_SI = units::arcsec;
  run.observed = s.reference_rad;
  run.residual = Eigen::VectorXd::Zero(readings);
  run.sigma = Eigen::VectorXd::Constant(readings, units::arcsec);
  run.nuisance.jacobian = Eigen::MatrixXd::Ones(readings, 1).sparseView();
  run.nuisance.prior_precision = Eigen::VectorXd::Constant(1, 1.0);
  return run;
}

std::vector<ResidualTest> TestsAsStated(const LinearRun& run, int null_runs, std::uint64_t seed) {
  return TestResiduals(run, {run.sigma, {}}, null_runs, seed);
}

const ResidualTest* Find(const std::vector<ResidualTest>& tests, const std::string& name) {
  const auto found = std::ranges::find(tests, name, &ResidualTest::name);
  return found == tests.end() ? nullptr : &*found;
}

}  // namespace twinbench::diagnose
