#include <algorithm>
#include <cmath>
#include <utility>

#include "twin/core/units.h"
#include "twin/diagnose/screen/circumstances.h"
#include "twin/diagnose/screen/scan.h"
#include "twin/diagnose/screen/tests.h"

namespace twinbench::diagnose::screen {
namespace {

/// Half cosine waves over the run.
Scan Wander(const Eigen::VectorXd& part) {
  Scan scan{"time: wander"};
  for (int k = 1; k <= 8; ++k) scan.Add((units::kPi * k * part.array()).cos(), k, k == 1 ? "" : "s");
  return scan;
}

/// Logarithm of the time since the set-up began: amplitude per decade.
Scan Creep(const Eigen::VectorXd& in_setup_s) {
  Scan scan{"time: creep"};
  for (double scale_s : {10.0, 60.0, 600.0}) scan.Add((1.0 + in_setup_s.array() / scale_s).log10(), scale_s);
  return scan;
}

Scan WarmUp(const Eigen::VectorXd& part, const Eigen::VectorXd& in_setup) {
  Scan scan{"time: exponential"};
  for (const auto& [time, since] :
       {std::pair(part, "start of the run"), std::pair(in_setup, "start of the set-up")}) {
    for (double decay : {0.01, 0.03, 0.1, 0.3}) scan.Add((-time.array() / decay).exp(), since, decay);
  }
  return scan;
}

/// Temperature with gaps closed by the value before.
Eigen::VectorXd Closed(const Eigen::VectorXd& temperature) {
  Eigen::VectorXd closed = temperature;
  double last = *std::ranges::find_if(temperature, [](double v) { return !std::isnan(v); });
  for (double& v : closed) last = v = std::isfinite(v) ? v : last;
  return closed;
}

/// What a body shows that follows with time constant `lag_s`: tau dx/dt = T - x, T held between readings.
Eigen::VectorXd Lagged(const Eigen::VectorXd& temperature, const Eigen::VectorXd& time_s, double lag_s) {
  Eigen::VectorXd body = temperature;
  for (Eigen::Index i = 1; i < body.size(); ++i) {
    const double keeps = lag_s > 0.0 ? std::exp(-(time_s[i] - time_s[i - 1]) / lag_s) : 0.0;
    body[i] = keeps * body[i - 1] + (1.0 - keeps) * temperature[i];
  }
  return body;
}

}  // namespace

void TestTime(const Sample& sample, Tests& tests) {
  const Eigen::VectorXd& time_s = sample.run.schedule.time_s;
  if (!Varies(time_s)) return;
  const double start_s = time_s.minCoeff(), duration_s = time_s.maxCoeff() - start_s;
  const Eigen::VectorXd part = (time_s.array() - start_s) / duration_s;
  const Eigen::VectorXd in_setup_s = TimeInSetup_s(sample.run.schedule);
  Scan drift{"time: drift"};
  drift.Add(part);
  for (const Scan& scan : {Wander(part), drift, Creep(in_setup_s), WarmUp(part, in_setup_s / duration_s)})
    TestScan(sample, scan, tests);
}

/// Something jumps at one moment and stays: up to 200 onsets, the first of which leaves two readings before it.
void TestSteps(const Sample& sample, Tests& tests) {
  constexpr int kMostOnsets = 200, kEdge = 2;
  const Schedule& schedule = sample.run.schedule;
  const int readings = schedule.Readings(), every = std::max(1, (readings + kMostOnsets - 1) / kMostOnsets);
  Scan scan{"time: step"};
  for (int onset = kEdge; onset + every <= readings - kEdge; onset += every) {
    Eigen::VectorXd step = Eigen::VectorXd::Zero(readings);
    step.tail(readings - onset).setOnes();
    scan.Add(step, schedule.reading[onset], schedule.time_s[onset]);
  }
  TestScan(sample, scan, tests);
}

void TestTemperature(const Sample& sample, Tests& tests) {
  const Eigen::VectorXd& time_s = sample.run.schedule.time_s;
  if (!Varies(sample.run.schedule.temperature_degC) || !Varies(time_s)) return;
  const Eigen::VectorXd temperature = Closed(sample.run.schedule.temperature_degC);
  Scan level{"temperature"}, rate{"temperature rate"};
  for (double lag_s : {0.0, 300.0, 600.0, 1200.0, 2400.0, 4800.0})
    level.Add(Normalised(Lagged(temperature, time_s, lag_s)),
              lag_s > 0.0 ? fmt::format(" with a lag of {:.0f} min", lag_s / 60.0) : "");
  // (T - T lagged) / lag is the rate of the smoothed temperature; a plain difference would be the sensor's noise.
  for (double lag_s : {300.0, 1200.0})
    rate.Add(Normalised(temperature - Lagged(temperature, time_s, lag_s)), lag_s / 60.0);
  TestScan(sample, level, tests);
  TestScan(sample, rate, tests);
}

}  // namespace twinbench::diagnose::screen
