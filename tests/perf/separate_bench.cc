#include <benchmark/benchmark.h>

#include "tests/separate/bench.h"
#include "twin/separate/shift_separation.h"

namespace {

using namespace twinbench;            // NOLINT: a benchmark program, not a header
using namespace twinbench::separate;  // NOLINT

/// 4 shifts, 4 passes; the reference run has 36 positions.
std::vector<Motion> FullCircles(int n) {
  Stream stream(1, "bench.truth");
  auto motions = EmptyMotions(n, {0, 1, 7, 11}, 4, ReadingCovariance());
  FillExact(motions, RandomTruth(n, stream), Layouts(n, Clamping::kReseat), Bench());
  return motions;
}

/// @param lost  Every so many-th reading is missing; 0: none.
void SeparateAll(benchmark::State& state, std::size_t lost) {
  const int n = static_cast<int>(state.range(0));
  auto motions = FullCircles(n);
  for (std::size_t i = 0; lost > 0 && i < motions.size(); i += lost) motions[i].status = ReadingStatus::kMissing;
  const BenchGeometry geometry = Bench();
  const SeparateOptions options = Options(n, Clamping::kReseat);
  for (auto _ : state) benchmark::DoNotOptimize(Separate(motions, geometry, options).dof);
  state.counters["s/position"] =
      benchmark::Counter(n, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

BENCHMARK_CAPTURE(SeparateAll, from_scratch, 0)->Arg(36)->Arg(360)->Arg(720)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(SeparateAll, with_gaps, 300)->Arg(360)->Unit(benchmark::kMillisecond);

void SeparateWithFactorisation(benchmark::State& state) {
  const auto motions = FullCircles(36);
  const Separator separator(motions, Bench(), Options(36, Clamping::kReseat));
  for (auto _ : state) benchmark::DoNotOptimize(separator.Separate(motions).dof);
}
BENCHMARK(SeparateWithFactorisation)->Unit(benchmark::kMillisecond);

/// Five shifts, readings of both curves with noise; a part of them missing, weights within a factor of `spread`.
struct ShiftedReadings {
  std::vector<int> shifts;
  Eigen::MatrixXd value, weight;
};

ShiftedReadings FiveShifts(int n, double missing, double spread) {
  ShiftedReadings r{{0, 1, n / 59, n / 9 + 11, n / 3 + 3}, Eigen::MatrixXd(n, 5), Eigen::MatrixXd(n, 5)};
  Stream stream(1, "bench.shifts");
  for (double& v : r.value.reshaped()) v = stream.Normal();
  for (double& w : r.weight.reshaped()) w = stream.Uniform() < missing ? 0.0 : std::pow(spread, stream.Uniform());
  return r;
}

/// From readings to both curves: transfers, factorisation, search for what is lost and the solution.
void SeparateTwoCurves(benchmark::State& state, double missing, double spread) {
  const ShiftedReadings r = FiveShifts(static_cast<int>(state.range(0)), missing, spread);
  shifts::ShiftSolution solution;
  for (auto _ : state) {
    const shifts::ShiftSeparation separation(r.shifts, r.weight);
    solution = separation.Solve(r.value);
  }
  const double n = static_cast<double>(state.range(0));
  state.counters["steps"] = solution.convergence.iterations;
  state.counters["converged"] = solution.convergence.converged ? 1.0 : 0.0;
  state.counters["s/(n log2 n)"] = benchmark::Counter(
      n * std::log2(n), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void Lengths(benchmark::internal::Benchmark* b) {  // the last is a prime
  for (const int n : {9000, 18000, 36000, 72000, 36007}) b->Arg(n)->Unit(benchmark::kMillisecond);
}
BENCHMARK_CAPTURE(SeparateTwoCurves, complete, 0.0, 1.0)->Apply(Lengths);
BENCHMARK_CAPTURE(SeparateTwoCurves, with_gaps_and_weights, 0.02, 10.0)->Apply(Lengths);

}  // namespace

BENCHMARK_MAIN();
