#include <benchmark/benchmark.h>

#include "tests/separate/bench.h"

namespace {

using namespace twinbench;            // NOLINT: a benchmark program, not a header
using namespace twinbench::separate;  // NOLINT

/// The reference run: 36 positions, 4 shifts, 4 passes.
std::vector<Motion> ReferenceRun() {
  Stream stream(1, "bench.truth");
  auto motions = EmptyMotions(36, {0, 1, 7, 11}, 4, ReadingCovariance());
  FillExact(motions, RandomTruth(36, stream), Layouts(36, Clamping::kReseat), Bench());
  return motions;
}

void SeparateFromScratch(benchmark::State& state) {
  const auto motions = ReferenceRun();
  const BenchGeometry geometry = Bench();
  const SeparateOptions options = Options(36, Clamping::kReseat);
  for (auto _ : state) benchmark::DoNotOptimize(Separate(motions, geometry, options).dof);
}
BENCHMARK(SeparateFromScratch)->Unit(benchmark::kMillisecond);

void SeparateWithFactorisation(benchmark::State& state) {
  const auto motions = ReferenceRun();
  const Separator separator(motions, Bench(), Options(36, Clamping::kReseat));
  for (auto _ : state) benchmark::DoNotOptimize(separator.Separate(motions).dof);
}
BENCHMARK(SeparateWithFactorisation)->Unit(benchmark::kMillisecond);

void FindSeparabilityOfADesign(benchmark::State& state) {
  const Design design = MakeDesign(36, {0, 1, 7, 11}, Clamping::kReseat, Bench());
  for (auto _ : state) benchmark::DoNotOptimize(FindSeparability(design).lost.size());
}
BENCHMARK(FindSeparabilityOfADesign)->Unit(benchmark::kMillisecond);

void MeasureAReading(benchmark::State& state) {
  Reading reading;
  reading.mean_V = {0.1, -0.2, 0.15, 0.05};
  reading.std_V.fill(0.006);
  reading.n_samples = 100;
  const std::vector<Reading> readings(576, reading);
  const BenchGeometry geometry = Bench();
  for (auto _ : state) {
    benchmark::DoNotOptimize(measure::Measure(readings, geometry, {}, measure::Estimator::kRigorous).size());
  }
  state.SetItemsProcessed(state.iterations() * 576);
}
BENCHMARK(MeasureAReading)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
