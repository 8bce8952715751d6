#pragma once

#include "tests/separate/waves.h"
#include "twin/benches/hob_transmission/estimators/transmission_error.h"
#include "twin/core/stream.h"

/// A hobbing machine for the tests of this folder, written from its description: angles go in, encoders read.
namespace twinbench::separate::hob {

using test::CoefficientOf, test::Pull2, test::ValueOf, test::Wave;

inline constexpr double kArcsec = units::arcsec;
inline constexpr double kTestTurn_rad = 2.0 * units::kPi;
inline constexpr double kTestRatio = 2.0 / 44.0;

struct HobMachine {
  std::vector<Wave> transmission = {};
  std::vector<Wave> encoder = {};  // in the encoder's own angle
  double noise_arcsec = 0.0;       // of one sample, white
  double interferometer_noise_arcsec = 0.0;
  bool interferometer = false;
  int samples_per_turn = 1440;
  double missing = 0.0;       // probability of a sample
  double jitter = 0.0;        // of the trigger, in sample steps, uniform to either side
  double speed_change = 0.0;  // samples follow a clock; speed varies by this part, 3 times in a turn
  double drift_arcsec_per_turn = 0.0;
};

struct Mounting {
  int setup = 0;
  double head_deg = 0.0;
  int direction = 1;
  int pass = 0;
  double turns = 4.0;
};

/// Where sample i looks for the table.
inline double TriggerAngle(const HobMachine& machine, int i, Stream& noise) {
  const double step_rad = kTestTurn_rad / machine.samples_per_turn;
  const double jitter = machine.jitter > 0.0 ? machine.jitter * (2.0 * noise.Uniform() - 1.0) : 0.0;
  const double regular_rad = step_rad * (i + jitter);
  return regular_rad + machine.speed_change / 3.0 * std::sin(3.0 * regular_rad);
}

inline HobSample SampleAt(const HobMachine& machine, const Mounting& at, double th_rad, double drift_rad,
                          Stream& noise) {
  const double head_rad = at.head_deg * units::deg;
  const double error_rad = ValueOf(machine.transmission, th_rad) + drift_rad;
  HobSample s{.setup = at.setup, .pass = at.pass, .direction = at.direction, .head_rad = head_rad};
  s.table_encoder_rad =
      th_rad + ValueOf(machine.encoder, th_rad - head_rad) + machine.noise_arcsec * kArcsec * noise.Normal();
  s.hob_encoder_rad = 0.3 + (th_rad - error_rad) / kTestRatio;  // the hob's count starts anywhere
  if (machine.interferometer)
    s.interferometer_rad = error_rad + machine.interferometer_noise_arcsec * kArcsec * noise.Normal();
  return s;
}

inline void AppendPass(const HobMachine& machine, const Mounting& at, Stream& noise,
                       std::vector<HobSample>& samples) {
  const double start_rad = 0.7;  // nobody starts at the origin
  const int count = static_cast<int>(std::lround(at.turns * machine.samples_per_turn));
  for (int i = 0; i < count; ++i) {
    const double moved_rad = TriggerAngle(machine, i, noise);
    const double drift_rad = machine.drift_arcsec_per_turn * kArcsec * moved_rad / kTestTurn_rad;
    const HobSample s = SampleAt(machine, at, start_rad + at.direction * moved_rad, drift_rad, noise);
    if (machine.missing == 0.0 || noise.Uniform() >= machine.missing) samples.push_back(s);
  }
}

inline std::vector<HobSample> Samples(const HobMachine& machine, const std::vector<Mounting>& setups,
                                      std::uint64_t seed = 1) {
  Stream noise(seed, "hob_bench");
  std::vector<HobSample> samples;
  for (const Mounting& at : setups) AppendPass(machine, at, noise, samples);
  return samples;
}

inline TransmissionOptions OrdersUpTo(int max_order) {
  return TransmissionOptions{.max_order = max_order};
}

/// One set-up a head, four turns forward.
inline std::vector<Mounting> Heads(const std::vector<double>& head_deg, double turns = 4.0) {
  std::vector<Mounting> setups;
  for (const double head : head_deg) setups.push_back({static_cast<int>(setups.size()), head, 1, 0, turns});
  return setups;
}

inline double DistanceArcsec(Complex a_rad, Complex b_rad) { return std::abs(a_rad - b_rad) / kArcsec; }

}  // namespace twinbench::separate::hob
