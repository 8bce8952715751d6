#pragma once

#include <vector>

#include "tests/diagnose/support/synthetic_run.h"
#include "twin/benches/names.h"
#include "twin/core/stream.h"
#include "twin/diagnose/diagnose.h"
#include "twin/diagnose/engine/projector.h"

/// A small run with the bones of the rotary bench: two channels that both see a target and a reference table by
/// position and a constant of each set-up; three set-ups, passes + - - +, some calibration readings before.
namespace twinbench::diagnose::test {

struct RingShape {
  int positions = 12;
  std::vector<int> shifts = {0, 1, 5};
  std::vector<int> passes = {1, -1, -1, 1};
  int calibration = 8;
};

inline constexpr double kRingSigma_m = 0.3e-6;
inline constexpr int kRingChannels = 2;

/// Unknowns: [target a, target b] by position, reference by position and channel, offsets by set-up and channel;
/// the calibration has offsets of its own.
inline LinearRun MakeRing(const RingShape& shape = {}) {
  LinearRun run;
  run.bench = kRotaryBench;
  run.channels = {"a", "b"};
  run.unit = "um";
  run.to_SI = 1e-6;
  const int n = shape.positions, setups = static_cast<int>(shape.shifts.size());
  const int reference = kRingChannels * n, offset = 2 * kRingChannels * n;
  Schedule& s = run.schedule;
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<double> time_s, target_rad, reference_rad;
  const auto add = [&](Phase phase, int setup, int pass, int direction, int position, int partner) {
    const int i = s.Readings();
    s.reading.push_back(i);
    s.setup.push_back(setup);
    s.pass.push_back(pass);
    s.direction.push_back(direction);
    s.position.push_back(position);
    s.phase.push_back(phase);
    time_s.push_back(5.0 * i);
    target_rad.push_back(2.0 * units::kPi * position / n);
    reference_rad.push_back(2.0 * units::kPi * partner / n);
    for (int c = 0; c < kRingChannels; ++c) {
      const int row = kRingChannels * i + c;
      const int constant = phase == Phase::kCalibration ? 0 : 1 + setup;
      entries.emplace_back(row, offset + kRingChannels * constant + c, 1.0);
      if (phase == Phase::kCalibration) continue;
      entries.emplace_back(row, kRingChannels * position + c, 1.0);
      entries.emplace_back(row, reference + kRingChannels * partner + c, 1.0);
    }
  };
  for (int i = 0; i < shape.calibration; ++i) add(Phase::kCalibration, 0, 0, 1, 0, 0);
  for (int setup = 0; setup < setups; ++setup) {
    for (std::size_t pass = 0; pass < shape.passes.size(); ++pass) {
      for (int step = 0; step < n; ++step) {
        const int position = shape.passes[pass] > 0 ? step : n - 1 - step;
        const int partner = ((shape.shifts[static_cast<std::size_t>(setup)] - position) % n + n) % n;
        add(Phase::kFullCircle, setup, static_cast<int>(pass), shape.passes[pass], position, partner);
      }
    }
  }
  const int readings = s.Readings(), unknowns = offset + kRingChannels * (1 + setups);
  const auto vector = [](const std::vector<double>& v) {
    return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(v.data(), static_cast<Eigen::Index>(v.size())));
  };
  s.time_s = vector(time_s);
  s.target_rad = vector(target_rad);
  s.reference_rad = vector(reference_rad);
  s.dwell_s = Eigen::VectorXd::Constant(readings, 1.0);
  s.temperature_degC = Eigen::VectorXd::Constant(readings, 20.0) + 1e-4 * s.time_s;
  s.velocity_rad_s = Eigen::VectorXd::Zero(readings);
  run.residual = Eigen::VectorXd::Zero(kRingChannels * readings);
  run.observed = run.residual;
  run.sigma = Eigen::VectorXd::Constant(run.residual.size(), kRingSigma_m);
  run.nuisance.jacobian.resize(run.residual.size(), unknowns);
  run.nuisance.jacobian.setFromTriplets(entries.begin(), entries.end());
  run.nuisance.prior_precision = Eigen::VectorXd::Constant(unknowns, 1.0 / (1e-2 * 1e-2));  // 1 cm: free
  run.nuisance.blocks = n;
  run.nuisance.block_size = kRingChannels;
  run.patterns = {{"both", Eigen::Vector2d(1.0, 1.0)}};
  return run;
}

inline NoiseModel WhiteNoise(const LinearRun& run) {
  return {run.sigma, {}};
}

/// White noise of the stated size.
inline void AddRingNoise(LinearRun& run, std::uint64_t seed, double size = 1.0) {
  Stream stream(seed, "ring.noise");
  for (int k = 0; k < run.Rows(); ++k) run.residual[k] += size * run.sigma[k] * stream.Normal();
}

/// A ring with nothing but white noise of the stated size.
inline LinearRun NoisyRing(std::uint64_t seed) {
  LinearRun run = MakeRing();
  AddRingNoise(run, seed);
  return run;
}

/// Gives the unknowns values of some micrometres.
inline void AddUnknowns(LinearRun& run, std::uint64_t seed) {
  Stream stream(seed, "ring.unknowns");
  Eigen::VectorXd x(run.nuisance.jacobian.cols());
  for (double& value : x) value = 5e-6 * stream.Normal();
  run.residual += run.nuisance.jacobian * x;
}

/// Channel a follows the direction of travel, the free unknowns cannot: a backlash.
inline Accepted Direction(const LinearRun& run) {
  Accepted accepted;
  accepted.family.kind = Kind::kNamed;
  accepted.family.effect = "backlash";
  accepted.family.where = "target";
  accepted.family.amplitudes = {{"half_width", "um", 1e-6, 3e-6, -1e-3, 1e-3}};
  accepted.columns = Eigen::MatrixXd::Zero(run.Rows(), 1);
  for (int i = 0; i < run.schedule.Readings(); ++i) {
    if (run.schedule.phase[static_cast<std::size_t>(i)] == Phase::kFullCircle)
      accepted.columns(kRingChannels * i, 0) = run.schedule.direction[static_cast<std::size_t>(i)];
  }
  accepted.amplitudes = Eigen::VectorXd::Zero(1);
  return accepted;
}

}  // namespace twinbench::diagnose::test
