/// How fast the twin draws noise, runs events and samples voltages.
///
///   bench_sampling                                   everything
///   bench_sampling --benchmark_filter=Block          A/D blocks only
///
/// Counters: normals, events, samples and full circles a second (process CPU time). A full circle is the sampling
/// of 2 set-ups x 36 positions x 4 channels x 1000 samples.
#include <benchmark/benchmark.h>

#include <random>

#include "twin/sim/ad_sampler.h"
#include "twin/sim/event_queue.h"

namespace twinbench::sim {
namespace {

using benchmark::Counter;

void CountPerSecond(benchmark::State& state, const char* what, double per_iteration) {
  state.counters[what] = Counter(per_iteration * static_cast<double>(state.iterations()), Counter::kIsRate);
}

constexpr std::size_t kNormals = 4096;

void BM_StandardNormals(benchmark::State& state) {
  std::mt19937 engine(1);
  std::normal_distribution<double> normal;
  std::vector<float> out(kNormals);
  for (auto _ : state) {
    for (float& x : out) x = static_cast<float>(normal(engine));
    benchmark::DoNotOptimize(out.data());
    benchmark::ClobberMemory();
  }
  CountPerSecond(state, "normals", kNormals);
}

void BM_FillNormals(benchmark::State& state, Simd simd) {
  if (!SimdRuns(simd)) return state.SkipWithError("not on this processor");
  Stream stream(1, "bench");
  stream.UseSimd(simd);
  std::vector<float> out(kNormals);
  for (auto _ : state) {
    stream.FillNormals(out);
    benchmark::DoNotOptimize(out.data());
    benchmark::ClobberMemory();
  }
  CountPerSecond(state, "normals", kNormals);
}

/// An event that adds its successor after a random delay.
struct Ping {
  EventQueue* queue;
  std::uint64_t random;
  void operator()() {
    random = random * 6364136223846793005u + 1442695040888963407u;
    queue->After(Duration(1 + static_cast<std::int64_t>(random >> 44)), *this);
  }
};

void BM_Events(benchmark::State& state) {
  EventQueue queue;
  for (std::int64_t i = 0; i < state.range(0); ++i)
    queue.After(Duration(i), Ping{&queue, static_cast<std::uint64_t>(i) * 77777u});
  for (auto _ : state) queue.RunOne();
  CountPerSecond(state, "events", 1.0);
}

AdInput Voltages() {
  AdInput input;
  for (std::size_t k = 0; k < kChannels; ++k) {
    input.channel[k].level_V = 0.3 * static_cast<double>(k);
    input.channel[k].noise_V = 6e-3;
  }
  return input;
}

AdInput VoltagesWithHumAndCrosstalk() {
  AdInput input = Voltages();
  input.hum.amplitude_V = 5e-3;
  for (ChannelInput& c : input.channel) {
    c.slope_V_s = 0.1;
    c.crosstalk = 1e-3;
    c.step_V = 1e-3;
    c.step_threshold_V = 5.0;
  }
  return input;
}

constexpr int kSamples = 1000;

void BM_Block(benchmark::State& state, const AdInput& input, Simd simd) {
  if (!SimdRuns(simd)) return state.SkipWithError("not on this processor");
  Stream noise(1, "bench");
  noise.UseSimd(simd);
  const AdcSettings adc;
  for (auto _ : state) benchmark::DoNotOptimize(TakeBlock(adc, input, {.n_samples = kSamples}, noise));
  CountPerSecond(state, "samples", kSamples * kChannels);
}

void BM_FullCircle(benchmark::State& state, bool every_sample) {
  Stream noise(1, "bench");
  const AdcSettings adc;
  const AdInput input = Voltages();
  for (auto _ : state) {
    for (std::uint64_t reading = 0; reading < 2 * 36; ++reading) {
      noise.Seek(reading << 20);
      const AdRequest request{.n_samples = kSamples, .every_sample = every_sample};
      benchmark::DoNotOptimize(TakeBlock(adc, input, request, noise));
    }
  }
  CountPerSecond(state, "full_circles", 1.0);
}

void RegisterVariant(Simd simd) {
  const std::string name = SimdName(simd);
  benchmark::RegisterBenchmark(("FillNormals/" + name).c_str(), BM_FillNormals, simd);
  benchmark::RegisterBenchmark(("Block/level/" + name).c_str(), BM_Block, Voltages(), simd);
  benchmark::RegisterBenchmark(("Block/hum_crosstalk_step/" + name).c_str(), BM_Block,
                               VoltagesWithHumAndCrosstalk(), simd);
}

void RegisterAll() {
  benchmark::RegisterBenchmark("Normals/mt19937_and_std_normal_distribution", BM_StandardNormals);
  for (const Simd simd : kAllSimd) RegisterVariant(simd);
  benchmark::RegisterBenchmark("FullCircle/every_sample", BM_FullCircle, true);
  benchmark::RegisterBenchmark("FullCircle/direct", BM_FullCircle, false);
  benchmark::RegisterBenchmark("Events/pending", BM_Events)->Arg(1)->Arg(1000);
}

}  // namespace
}  // namespace twinbench::sim

int main(int argc, char** argv) {
  twinbench::sim::RegisterAll();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
