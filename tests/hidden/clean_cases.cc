#include "tests/hidden/twin_cases.h"

#include <utility>

#include "twin/benches/circular_motion/columns.h"
#include "twin/benches/circular_motion/settings.h"
#include "twin/benches/encoder_comparison/settings.h"
#include "twin/benches/freeform_five_axis/settings.h"
#include "twin/benches/hob_transmission/settings.h"
#include "twin/benches/names.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/turntable_autocollimator/settings.h"

namespace twinbench::hidden {
namespace {

/// What a noise does: distribution, correlation from reading to reading, and how much of its size is stated.
struct NoiseShape {
  const char* name;
  bool student = false;
  double correlation = 0.0;
  double stated = 1.0;  // stated / actual standard deviation
};

const std::array<NoiseShape, kNoises> kShapes = {{{"Gaussian"}, {"Student t, 5 dof", true},
                                                  {"AR(1) 0.2", false, 0.2}, {"AR(1) 0.3", false, 0.3},
                                                  {"25 % larger than stated", false, 0.0, 1.0 / 1.25},
                                                  {"25 % smaller than stated", false, 0.0, 1.0 / 0.75},
                                                  {"t5, AR(1) 0.2, 25 % larger than stated", true, 0.2, 1.0 / 1.25}}};

/// A series of unit variance in the order of the readings.
class Series {
 public:
  Series(NoiseShape shape, std::uint64_t seed, const std::string& channel)
      : shape_(shape), stream_(seed, "hidden.noise." + channel), last_(Innovation()) {}
  double Next() {
    last_ = shape_.correlation * last_ + std::sqrt(1.0 - shape_.correlation * shape_.correlation) * Innovation();
    return last_;
  }

 private:
  double Innovation() {
    constexpr double kDegrees = 5.0;
    const double normal = stream_.Normal();
    if (!shape_.student) return normal;
    // Student's t has variance dof / (dof - 2).
    return normal / std::sqrt(stream_.ChiSquared(kDegrees) / kDegrees) * std::sqrt((kDegrees - 2.0) / kDegrees);
  }

  NoiseShape shape_;
  Stream stream_;
  double last_;
};

/// Noise on the means, and blocks that state a deviation with the scatter that so many samples give it.
void AddToVoltages(const NoiseShape& shape, double sample_noise_V, std::uint64_t seed,
                   std::vector<Reading>& readings) {
  for (std::size_t c = 0; c < kChannels; ++c) {
    Series series(shape, seed, kChannelNames[c]);
    Stream blocks(seed, std::string("hidden.blocks.") + kChannelNames[c]);
    for (Reading& r : readings) {
      const double n = r.n_samples;
      r.mean_V[c] += sample_noise_V / std::sqrt(n) * series.Next();
      r.std_V[c] = shape.stated * sample_noise_V * std::sqrt(blocks.ChiSquared(n - 1.0) / (n - 1.0));
    }
  }
}

std::vector<Reading> RotaryReadings(const NoiseShape& shape, Scenario actual, std::uint64_t seed) {
  const double sample_noise_V = std::exchange(RotaryOf(actual).amplifier.noise_V, 0.0);
  std::vector<Reading> readings = TakeReadings(actual);
  AddToVoltages(shape, sample_noise_V, seed, readings);
  return readings;
}

/// Everything that a scenario states as noise of the channels; none is on them where the twin is to stay silent.
std::vector<double*> StatedNoises(Scenario& scenario) {
  if (scenario.bench == kTurntableBench) return {&TurntableOf(scenario).autocollimator.noise_rad};
  if (scenario.bench == kHobBench) return {&HobOf(scenario).table_encoder.noise_rad};
  if (scenario.bench == kEncoderBench) return {&EncoderOf(scenario).device.noise_rad};
  if (scenario.bench == kFreeformBench) return {&FreeformOf(scenario).qpd.noise_V, &FreeformOf(scenario).ccd.noise_px};
  CircularSettings& s = CircularOf(scenario);
  return {&s.machine.noise_m, &s.bar.noise_m, &s.encoder.noise_rad, &s.grid.noise_m};
}

/// Standard deviation of what each channel of a reading shows.
Eigen::VectorXd Deviations(Scenario& scenario, const Reading& r) {
  const std::vector<double*> stated = StatedNoises(scenario);
  if (scenario.bench == kFreeformBench) return Eigen::Vector3d(*stated[0], *stated[0], *stated[1]);
  if (scenario.bench != kCircularBench)
    return Eigen::VectorXd::Constant(scenario.bench == kTurntableBench ? 2 : 1, *stated[0]);
  const CircularSettings& s = CircularOf(scenario);
  const bool bar = benches::circular::IsOfBar(r);
  const double radial_m = bar ? s.bar.noise_m : s.grid.noise_m;
  const double tangential_m = bar ? benches::circular::Radius_m(r) * s.encoder.noise_rad : s.grid.noise_m;
  return Eigen::Vector2d(std::hypot(s.machine.noise_m, radial_m), std::hypot(s.machine.noise_m, tangential_m));
}

/// Names cases' random streams: they stay what they were.
std::string StreamOf(const std::string& bench, Eigen::Index channel) {
  if (bench == kTurntableBench) return channel == 0 ? "x" : "y";
  return bench == kHobBench || bench == kEncoderBench ? "angle" : "channel " + std::to_string(channel);
}

/// Noise of this shape on readings that are taken without; the scenario states what the shape says.
Case WithNoise(const NoiseShape& shape, Scenario actual, Case clean, std::uint64_t seed) {
  Scenario noisy = actual;
  for (double* noise : StatedNoises(actual)) *noise = 0.0;
  clean.readings = TakeReadings(actual);
  const Eigen::Index channels = Deviations(noisy, clean.readings.front()).size();
  Eigen::MatrixXd noise(std::ssize(clean.readings), channels);
  for (Eigen::Index c = 0; c < channels; ++c) {
    Series series(shape, seed, StreamOf(actual.bench, c));
    for (Eigen::Index i = 0; i < noise.rows(); ++i)
      noise(i, c) = Deviations(noisy, clean.readings[static_cast<std::size_t>(i)])[c] * series.Next();
  }
  AddTo(actual.bench, noise, clean.readings);
  for (double* stated : StatedNoises(clean.scenario)) *stated *= shape.stated;
  if (shape.stated != 1.0 && actual.bench == kEncoderBench) EncoderOf(clean.scenario).device.noise_known = true;
  return clean;
}

Case MakeClean(Design design, const NoiseShape& shape, std::uint64_t seed) {
  Case clean;
  clean.hidden.noise = shape.name;
  clean.scenario = Believed(design);
  const Scenario actual = Drawn(design, seed);
  if (design != Design::kRotary) return WithNoise(shape, actual, clean, seed);
  clean.readings = RotaryReadings(shape, actual, seed);
  return clean;
}

}  // namespace

std::vector<Plan> CleanPlans(const std::string& bench, int count, std::uint64_t first_seed) {
  const std::vector<Design> designs = PlainDesigns(bench);
  std::vector<Plan> plans;
  for (int k = 0; k < count; ++k) {
    const NoiseShape& shape = kShapes[static_cast<std::size_t>(k % kNoises)];
    const Design design = designs[static_cast<std::size_t>(k / kNoises) % designs.size()];
    const std::uint64_t seed = 300000 + first_seed + static_cast<std::uint64_t>(k);
    plans.push_back({"clean " + bench, std::to_string(seed), [=] { return MakeClean(design, shape, seed); }});
  }
  return plans;
}

}  // namespace twinbench::hidden
