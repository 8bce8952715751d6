#pragma once

#include <algorithm>

#include "tests/diagnose/support/synthetic_run.h"
#include "twin/core/stream.h"
#include "twin/diagnose/diagnose.h"

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

inline LinearRun MakeRing(const RingShape& shape = {}) {
  LinearRun run = SyntheticRun({.positions = shape.positions, .shifts = shape.shifts, .passes = shape.passes,
                                .sigma_m = kRingSigma_m, .channels = kRingChannels,
                                .calibration = shape.calibration});
  Schedule& s = run.schedule;
  for (int& pass : s.pass) pass %= std::max(1, static_cast<int>(shape.passes.size()));  // counted anew in every set-up
  s.time_s = 5.0 * Eigen::VectorXd::LinSpaced(s.Readings(), 0.0, s.Readings() - 1.0);
  s.dwell_s.setOnes();
  s.temperature_degC = Eigen::VectorXd::Constant(s.Readings(), 20.0) + 1e-4 * s.time_s;
  s.velocity_rad_s.setZero();
  run.channels = {"a", "b"};
  run.observed.setZero();
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

/// A term of one amplitude as a search leaves it.
inline Accepted TermOf(const std::string& effect, const Eigen::VectorXd& signature, double size,
                       Kind kind = Kind::kNamed,
                       const Amplitude& amplitude = {"size", "um", 1e-6, 3e-6, -1e-3, 1e-3}) {
  Accepted term;
  term.family.kind = kind;
  term.family.effect = effect;
  term.family.amplitudes = {amplitude};
  term.columns = signature;
  term.amplitudes = Eigen::VectorXd::Constant(1, size);
  return term;
}

/// Channel a follows the direction of travel, the free unknowns cannot: a backlash.
inline Accepted Direction(const LinearRun& run) {
  Eigen::VectorXd signature = Eigen::VectorXd::Zero(run.Rows());
  for (int i = 0; i < run.schedule.Readings(); ++i) {
    if (run.schedule.phase[static_cast<std::size_t>(i)] == Phase::kFullCircle)
      signature[kRingChannels * i] = run.schedule.direction[static_cast<std::size_t>(i)];
  }
  Accepted direction = TermOf("backlash", signature, 0.0);
  direction.family.where = "target";
  return direction;
}

}  // namespace twinbench::diagnose::test
