#include <benchmark/benchmark.h>

#include <numbers>
#include <random>

#include "mechanics/error_motion.h"
#include "mechanics/linear_model.h"
#include "mechanics/plant.h"
#include "mechanics/sag.h"

// Times of the mechanics. `full_circles/s` is what one core does of two set-ups x 36 counter-rotating stops of 10
// deg, without optics and samples.
namespace twinbench::mechanics {
namespace {

constexpr double kStep_rad = 10.0 * std::numbers::pi / 180.0;
constexpr int kStops = 72;

ErrorMotion RandomErrors(unsigned seed) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal;
  return ErrorMotion(MakeRandomHarmonics({1e-5, 1e-5, 1e-5, 1e-6, 1e-6, 1e-6}, 12, [&] { return normal(engine); }));
}

ErrorMotion TabulatedErrors(unsigned seed) {
  const ErrorMotion source = RandomErrors(seed);
  ErrorTable table;
  for (int i = 0; i < 72; ++i) {
    table.angle_rad.push_back(0.5 * i * kStep_rad);
    const auto e = source.Evaluate(table.angle_rad.back()).Array();
    for (std::size_t c = 0; c < e.size(); ++c) table.value[c].push_back(e[c]);
  }
  return ErrorMotion({}, table);
}

StackParameters Stack(bool eccentric) {
  StackParameters p;
  if (eccentric) p.payload = {1.5, 0.040, 0.3, 0.05, 1e-3};
  return p;
}

void CountCircles(benchmark::State& state) {
  state.counters["full_circles/s"] =
      benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

void CirclesOfErrors(benchmark::State& state, const ErrorMotion& target, const ErrorMotion& reference, bool chain) {
  const Chain links{ChainGeometry{}};
  double sum = 0.0;
  for (auto _ : state) {
    for (int i = 0; i < kStops; ++i) {
      ChainState s;
      s.target_rad = i * kStep_rad;
      s.reference_rad = -i * kStep_rad;
      s.target_error = target.Evaluate(s.target_rad);
      s.reference_error = reference.Evaluate(s.reference_rad);
      sum += chain ? links.GratingPose(s)(0, 3) : s.target_error.ex_rad + s.reference_error.dz_m;
    }
  }
  benchmark::DoNotOptimize(sum);
  CountCircles(state);
}

void BM_ErrorsOfHarmonics(benchmark::State& state) {
  CirclesOfErrors(state, RandomErrors(1), RandomErrors(2), false);
}
void BM_ErrorsOfTables(benchmark::State& state) {
  CirclesOfErrors(state, TabulatedErrors(1), TabulatedErrors(2), false);
}
void BM_ErrorsAndChain(benchmark::State& state) {
  CirclesOfErrors(state, RandomErrors(1), RandomErrors(2), true);
}

void BM_FullCircle(benchmark::State& state, Fidelity fidelity, bool eccentric) {
  const StackParameters parameters = Stack(eccentric);
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
  CountCircles(state);
}

/// Friction rules superposition out: every period is computed.
void BM_FullCircleLinearWithFriction(benchmark::State& state) {
  StackParameters parameters = Stack(true);
  for (TableParameters& table : parameters.table) table.friction.coulomb_Nm = 0.02;
  for (auto _ : state) {
    const auto plant = MakePlant(Fidelity::kLinear, parameters);
    for (int i = 1; i <= kStops; ++i) {
      plant->StartMove(Axis::kTarget, i * kStep_rad, 0.6);
      plant->StartMove(Axis::kReference, -i * kStep_rad, 0.6);
      plant->AdvanceUntilSettled(5.0);
    }
  }
  CountCircles(state);
}

void BM_StackStep(benchmark::State& state, Integrator integrator, double step_s) {
  StackDynamics dynamics(Stack(true));
  Vector12 q = Vector12::Zero();
  Vector12 qd = Vector12::Zero();
  for (auto _ : state) dynamics.Step(integrator, step_s, {0.0, 0.0}, q, qd);
  benchmark::DoNotOptimize(q);
}

void BM_LinearStep(benchmark::State& state) {
  const StackParameters parameters = Stack(true);
  const LinearModel model(parameters);
  LinearStack stack(parameters, model);
  PeriodCommand command;
  command.acceleration_rad_s2 << 1.0, -1.0;
  for (auto _ : state) stack.Step(command);
  benchmark::DoNotOptimize(stack);
}

void BM_LinearModelAndOneResponse(benchmark::State& state) {
  const StackParameters parameters = Stack(true);
  for (auto _ : state) {
    const LinearModel model(parameters);
    benchmark::DoNotOptimize(MoveResponse(parameters, model, 0.6));
  }
}

void BM_StaticDeflection(benchmark::State& state) {
  const StackParameters parameters = Stack(true);
  for (auto _ : state) benchmark::DoNotOptimize(StaticDeflection(parameters, 0.3, -0.3));
}

BENCHMARK(BM_ErrorsOfHarmonics)->Unit(benchmark::kMicrosecond);
BENCHMARK(BM_ErrorsOfTables)->Unit(benchmark::kMicrosecond);
BENCHMARK(BM_ErrorsAndChain)->Unit(benchmark::kMicrosecond);
BENCHMARK(BM_StaticDeflection)->Unit(benchmark::kMicrosecond);
BENCHMARK(BM_LinearStep);
BENCHMARK(BM_LinearModelAndOneResponse)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_StackStep, leapfrog, Integrator::kLeapfrog, 250e-6)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(BM_StackStep, runge_kutta_4, Integrator::kRungeKutta4, 500e-6)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(BM_FullCircle, kinematic, Fidelity::kKinematic, false)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(BM_FullCircle, kinematic_eccentric, Fidelity::kKinematic, true)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(BM_FullCircle, linear, Fidelity::kLinear, false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_FullCircle, linear_eccentric, Fidelity::kLinear, true)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_FullCircleLinearWithFriction)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_FullCircle, bullet, Fidelity::kBullet, true)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace twinbench::mechanics

BENCHMARK_MAIN();
