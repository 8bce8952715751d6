// How many full-circle tests a second can one core carry out?
//
// One test is the paper's: 2 set-ups x 36 positions x 4 channels x 1000 samples through procedure, event queue,
// devices, chain, light and A/D, readings kept in memory; building the twin is part of it. The counter
// `tests_per_s` is per second of CPU time, `of_goal` the ratio to what the project asks for. Light by the closed
// form. `to_kernels` is the time of a test over that of its random numbers, poses and
// light alone.
//
//   build/tests/perf/bench_full_circle --benchmark_counters_tabular=true
#include <benchmark/benchmark.h>

#include "tests/perf/timing.h"
#include "tests/support/rotary_scenario.h"
#include "twin/benches/rotary_4dof/procedure/procedure.h"
#include "twin/benches/rotary_4dof/twin/optical_path.h"
#include "twin/benches/rotary_4dof/twin/table_stack.h"
#include "twin/benches/rotary_4dof/twin/twin.h"
#include "twin/core/stream.h"

namespace twinbench {
namespace {

using perf::Median, perf::Seconds;

class CountingSink : public ReadingSink {
 public:
  void Append(const Reading& reading, const Acquisition& /*block*/) override {
    if (reading.status == ReadingStatus::kOk) ++valid;
  }
  int valid = 0;
};

Scenario PaperTest(const std::string& fidelity, bool every_sample) {
  const std::string tables =
      "bench = \"rotary_4dof\"\noptics.fidelity = \"closed\"\nadc.samples = 1000\n"
      "target.random = { ex_arcsec = 4, ey_arcsec = 4, ez_arcsec = 5, dx_um = 2, dy_um = 2, dz_um = 1 }\n"
      "reference.random = { ex_arcsec = 8, ey_arcsec = 8, ez_arcsec = 15, dx_um = 3, dy_um = 3, dz_um = 2 }\n"
      "[procedure]\nphases = [\"full_circle\"]\nshifts = [0, 1]\npasses = [1]\n";
  return ParseScenario(tables, "paper.toml", "",
                       {"mechanics.fidelity=" + fidelity, std::string("adc.every_sample=") + (every_sample ? "true" : "false")});
}

int ValidReadings(const Scenario& scenario) {
  sim::Twin twin(scenario);
  RotaryBench bench = twin.Bench();
  CountingSink sink;
  procedure::CarryOut(bench, scenario, sink);
  return sink.valid;
}

void CarryOutFullCircles(benchmark::State& state, const std::string& fidelity, bool every_sample, double goal) {
  Scenario scenario = PaperTest(fidelity, every_sample);
  int valid = 0;
  for (auto _ : state) {
    ++scenario.seed;
    valid += ValidReadings(scenario);
  }
  if (valid != 72 * state.iterations()) state.SkipWithError("a reading is not valid");
  const double tests = static_cast<double>(state.iterations());
  state.counters["tests_per_s"] = benchmark::Counter(tests, benchmark::Counter::kIsRate);
  state.counters["of_goal"] = benchmark::Counter(tests / goal, benchmark::Counter::kIsRate);
}

/// What a full-circle test cannot do without, alone: as many random numbers as it draws, as many poses of the grating
/// and as many questions to the light as it asks, on tables that its random numbers have made. No clock, no devices,
/// no converter, no readings.
class Kernels {
 public:
  explicit Kernels(const Scenario& scenario)
      : scenario_(scenario), path_(scenario), noise_(scenario.seed, "noise"), others_(scenario.seed, "others") {
    sim::EventQueue queue;
    const mechanics::StackState rest = sim::Axes(sim::RotaryTableStack(path_.actual()), queue).Look();
    bearings_ = {rest.target_bearing, rest.reference_bearing};  // deflected by the weights that they carry
  }

  void Run() {
    const TableSettings& table = RotaryOf(scenario_).target;
    DrawNormals(2 * 2 * kComponents * table.random_orders);  // sine and cosine of both tables' lines
    const ProcedureSettings& procedure = RotaryOf(scenario_).procedure;
    for (std::size_t setup = 0; setup < procedure.shifts.size(); ++setup) {
      DrawNormals(2 * kComponents);  // seating of both tables
      for (int k = 0; k < procedure.positions; ++k) Read(k * units::turn / procedure.positions);
    }
  }

  double sum() const { return sum_; }

 private:
  void Read(double angle_rad) {
    sum_ += others_.Uniform() + others_.Normal();  // dwell, thermometer
    for (int knot = 0; knot < 2; ++knot) {         // begin and end of the block
      sim::Moment moment;
      moment.target_rad = angle_rad + knot;
      moment.reference_rad = -angle_rad;
      const Pose X_LG = path_.stand().GratingPose(moment, {}, {angle_rad, -angle_rad}, bearings_);
      sum_ += path_.light().Trace(X_LG, path_.light().Nominal(0.0)).uv_m[0];
    }
    RotaryOf(scenario_).adc.every_sample ? DrawSamples() : DrawStatistics();
  }

  void DrawNormals(int n) {
    for (int i = 0; i < n; ++i) sum_ += others_.Normal();
  }

  void DrawSamples() {
    constexpr int kScan = 4, kTogether = 1024;
    std::array<float, kTogether> normals;
    const int samples = kScan * (RotaryOf(scenario_).adc.samples + 1);  // the scan before crosses over into the first
    for (int begin = 0; begin < samples; begin += kTogether) {
      const auto n = static_cast<std::size_t>(std::min(kTogether, samples - begin));
      noise_.FillNormals(std::span(normals).first(n));
      sum_ += normals[0];
    }
  }

  /// Noise of the mean, its quantisation, and the deviation.
  void DrawStatistics() {
    for (int c = 0; c < kChannels; ++c) {
      sum_ += noise_.Normal() + noise_.Normal() + noise_.ChiSquared(RotaryOf(scenario_).adc.samples - 1.0);
    }
  }

  Scenario scenario_;
  sim::OpticalPath path_;
  Stream noise_, others_;
  std::array<mechanics::BearingPose, 2> bearings_;
  double sum_ = 0.0;
};

double SecondsOfRun(const Scenario& scenario) {
  const double start = Seconds();
  benchmark::DoNotOptimize(ValidReadings(scenario));
  return Seconds() - start;
}

/// A whole full-circle test against its kernels alone, by turns; the counter is the median of the rounds' ratios.
void FullCircleAgainstItsKernels(benchmark::State& state, bool every_sample) {
  Scenario scenario = PaperTest("kinematic", every_sample);
  Kernels kernels(scenario);
  std::vector<double> ratio, whole_s, kernels_s;
  for (auto _ : state) {
    ++scenario.seed;
    const double start = Seconds();
    kernels.Run();
    kernels_s.push_back(Seconds() - start);
    whole_s.push_back(SecondsOfRun(scenario));
    ratio.push_back(whole_s.back() / kernels_s.back());
  }
  benchmark::DoNotOptimize(kernels.sum());
  state.counters["to_kernels"] = Median(ratio);
  state.counters["whole_us"] = Median(whole_s) * 1e6;
  state.counters["kernels_us"] = Median(kernels_s) * 1e6;
}
BENCHMARK_CAPTURE(FullCircleAgainstItsKernels, every_sample, true)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(FullCircleAgainstItsKernels, sufficient_statistics, false)->Unit(benchmark::kMillisecond);

double SecondsOf(Scenario scenario, const std::string& light) {
  RotaryOf(scenario).optics.fidelity = light;
  return SecondsOfRun(scenario);
}

/// The reference bench's whole run, 628 readings, by turns; `traced_to_closed` is the median of the rounds' ratios.
void RunTracedAgainstClosed(benchmark::State& state) {
  const Scenario scenario = test::RotaryScenario();
  std::vector<double> ratio;
  for (auto _ : state) ratio.push_back(SecondsOf(scenario, "traced") / SecondsOf(scenario, "closed"));
  state.counters["traced_to_closed"] = Median(ratio);
}
BENCHMARK(RunTracedAgainstClosed)->Unit(benchmark::kMillisecond);

BENCHMARK_CAPTURE(CarryOutFullCircles, kinematic_every_sample, "kinematic", true, 600.0)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(CarryOutFullCircles, kinematic_sufficient_statistics, "kinematic", false, 10000.0)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(CarryOutFullCircles, linear_every_sample, "linear", true, 60.0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(CarryOutFullCircles, bullet_every_sample, "bullet", true, 0.4)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(2);

}  // namespace
}  // namespace twinbench

BENCHMARK_MAIN();
