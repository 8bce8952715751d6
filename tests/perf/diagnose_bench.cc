#include <benchmark/benchmark.h>

#include <cmath>
#include <functional>
#include <random>

#include "tests/perf/timing.h"
#include "twin/benches/encoder_comparison/settings.h"
#include "twin/benches/names.h"
#include "twin/benches/registry.h"
#include "twin/core/units.h"
#include "twin/model/signals.h"
#include "twin/model/wave_sums.h"

// What size of data a diagnosis takes: sums over many waves beside a sine a reading a wave, and whole diagnoses.
namespace {

using namespace twinbench;  // NOLINT: a benchmark program, not a header
using units::deg;

constexpr int kOrders = 720;

Eigen::VectorXd UnevenTurns_rad(Eigen::Index readings) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> turns(0.0, 4.0);
  return Eigen::VectorXd::NullaryExpr(readings, [&] { return units::turn * turns(random); });
}

void SumOverWaves(benchmark::State& state) {
  const Eigen::VectorXd angle_rad = UnevenTurns_rad(state.range(0));
  const model::WaveSums sums(angle_rad, 1.0, 1.0, kOrders);
  for (auto _ : state) benchmark::DoNotOptimize(sums.Of(angle_rad)(0, 0));
  state.counters["readings_x_waves/s"] = benchmark::Counter(static_cast<double>(state.range(0)) * kOrders,
                                                            benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(SumOverWaves)->Arg(2000)->Arg(20000)->Arg(200000)->Unit(benchmark::kMillisecond);

void SumOverWavesOneByOne(benchmark::State& state) {
  const Eigen::VectorXd angle_rad = UnevenTurns_rad(state.range(0));
  for (auto _ : state) {
    for (int k = 1; k <= kOrders; ++k) {
      const Eigen::Vector2d sum = model::Wave(k * angle_rad).transpose() * angle_rad;
      benchmark::DoNotOptimize(sum[0]);
    }
  }
  state.counters["readings_x_waves/s"] = benchmark::Counter(static_cast<double>(state.range(0)) * kOrders,
                                                            benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(SumOverWavesOneByOne)->Arg(2000)->Arg(20000)->Unit(benchmark::kMillisecond);

/// Eight passes of two turns, four at 36 deg/s and four at 12 deg/s, with noise of 0.002 deg.
using Error = std::function<double(const Reading&)>;
std::vector<Reading> Read(int count, const Error& error_deg) {
  std::mt19937_64 random(2);
  std::normal_distribution<double> noise_deg(0.0, 0.002);
  std::vector<Reading> readings;
  const double every_s = 320.0 / count;
  double begin_s = 0.0;
  for (int pass = 0; pass < 8; ++pass) {
    const double direction = std::vector{1.0, -1.0, -1.0, 1.0}[static_cast<std::size_t>(pass % 4)];
    const double speed_deg_s = pass < 4 ? 36.0 : 12.0, lasts_s = 720.0 / speed_deg_s;
    for (double t_s = 0.5 * every_s; t_s < lasts_s; t_s += every_s) {
      const double way_deg = speed_deg_s * t_s, angle_deg = direction > 0.0 ? way_deg : 720.0 - way_deg;
      Reading r;
      r.reading = static_cast<int>(readings.size());
      r.time = Time(FromSeconds(begin_s + t_s));
      r.pass = pass;
      r.direction = static_cast<int>(direction);
      r.reference_rad = angle_deg * deg;
      r.velocity_rad_s = direction * speed_deg_s * deg;
      r.measured_rad = r.reference_rad + (error_deg(r) + noise_deg(random)) * deg;
      readings.push_back(r);
    }
    begin_s += lasts_s + 2.0;
  }
  return readings;
}

void Diagnose(benchmark::State& state, const Error& error_deg) {
  const std::vector<Reading> readings = Read(static_cast<int>(state.range(0)), error_deg);
  Scenario scenario;
  scenario.bench = kEncoderBench;
  EncoderOf(scenario).encoder_procedure.kind = "sweep";
  const double begin_s = perf::Seconds();
  for (auto _ : state) benchmark::DoNotOptimize(diagnose::Diagnose(readings, scenario, {}).diagnosis.readings);
  const double taken_s = perf::Seconds() - begin_s;
  constexpr double kAsked_s = 10.0;  // of 20 000 readings
  state.counters["asked/taken"] = kAsked_s * static_cast<double>(state.iterations()) / taken_s;
}

double OneOrder_deg(const Reading& r) { return 0.02 * std::cos(7.0 * r.reference_rad); }
double FourLarge_deg(const Reading& r) {
  return 0.3 * std::cos(7.0 * r.reference_rad) + 0.5 * std::cos(r.reference_rad + 0.9) -
         0.02 * r.velocity_rad_s / deg + 1e-3 * ToSeconds(r.time);
}
void Sizes(benchmark::internal::Benchmark* b) {
  b->Arg(2000)->Arg(20000)->Iterations(1)->Unit(benchmark::kSecond);
}
BENCHMARK_CAPTURE(Diagnose, nothing, [](const Reading&) { return 0.0; })->Apply(Sizes);
BENCHMARK_CAPTURE(Diagnose, one_order, OneOrder_deg)->Apply(Sizes);
BENCHMARK_CAPTURE(Diagnose, four_large, FourLarge_deg)->Apply(Sizes);

}  // namespace

BENCHMARK_MAIN();
