#include <benchmark/benchmark.h>

#include <numbers>

#include "mechanics/plant.h"

// Times of the mechanics. `full_circles/s` is what one core does of two set-ups x 36 counter-rotating stops of 10
// deg, without optics and samples.
namespace twinbench::mechanics {
namespace {

constexpr double kStep_rad = 10.0 * std::numbers::pi / 180.0;
constexpr int kStops = 72;

StackParameters EccentricStack() {
  StackParameters p;
  p.payload = {1.5, 0.040, 0.3, 0.05, 1e-3};
  return p;
}

void TurnInCircles(benchmark::State& state, Fidelity fidelity, const StackParameters& parameters) {
  double sum = 0.0;
  for (auto _ : state) {
    const auto plant = MakePlant(fidelity, parameters);  // as a campaign does: a plant a test
    for (int i = 1; i <= kStops; ++i) {
      plant->StartMove(Axis::kTarget, i * kStep_rad, 0.6);
      plant->StartMove(Axis::kReference, -i * kStep_rad, 0.6);
      plant->AdvanceUntilSettled(5.0);
      sum += plant->State().target_rad;
    }
  }
  benchmark::DoNotOptimize(sum);
  state.counters["full_circles/s"] =
      benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

void BM_FullCircle(benchmark::State& state, Fidelity fidelity) {
  TurnInCircles(state, fidelity, EccentricStack());
}

/// Friction rules superposition out: every period is computed.
void BM_FullCircleLinearWithFriction(benchmark::State& state) {
  StackParameters parameters = EccentricStack();
  for (TableParameters& table : parameters.table) table.friction.coulomb_Nm = 0.02;
  TurnInCircles(state, Fidelity::kLinear, parameters);
}

BENCHMARK_CAPTURE(BM_FullCircle, kinematic_eccentric, Fidelity::kKinematic)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(BM_FullCircle, linear_eccentric, Fidelity::kLinear)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_FullCircleLinearWithFriction)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_FullCircle, bullet, Fidelity::kBullet)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace twinbench::mechanics

BENCHMARK_MAIN();
