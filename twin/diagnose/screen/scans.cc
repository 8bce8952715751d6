#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "twin/core/units.h"
#include "twin/diagnose/screen/circumstances.h"
#include "twin/diagnose/screen/scan.h"
#include "twin/diagnose/screen/tests.h"

/// Shapes in time, temperature, angle and direction that the residual may follow.
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
       {std::pair(part, "start of the run"), std::pair(in_setup, "start of the mounting")}) {
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

/// A bearing's cage turns at 0.38 to 0.5 of the shaft; half turns and their odd multiples repeat every second turn.
constexpr std::array kHalfTurnOrders = {0.38, 0.40, 0.42, 0.44, 0.46, 0.48, 0.50, 1.5, 2.5, 3.5};

/// Direction of each reading, 0 where its place was not visited the other way round. Continuous motion hardly ever
/// comes back to a place: if there are no pairs, every reading counts that was taken outside the calibration.
Eigen::VectorXd PairedDirection(const Schedule& s) {
  constexpr int kLeastPairs = 4;
  std::map<PlaceKey, std::array<bool, 2>> visited;
  for (int i = 0; i < s.Readings(); ++i) visited[PlaceOfReading(s, i)][s.direction[i] > 0] = true;
  const auto pairs =
      std::ranges::count_if(visited, [](const auto& place) { return place.second[0] && place.second[1]; });
  Eigen::VectorXd direction = Eigen::VectorXd::Zero(s.Readings());
  for (int i = 0; i < s.Readings(); ++i) {
    const auto [back, forth] = visited[PlaceOfReading(s, i)];
    const bool counts = pairs >= kLeastPairs ? back && forth : s.phase[i] != Phase::kCalibration;
    if (counts) direction[i] = s.direction[i];
  }
  return direction;
}

/// Direction times harmonics of the angle: backlash that differs around the turn.
void TestAround(const Sample& s, const Eigen::VectorXd& direction, Tests& tests) {
  for (const AngleArgument& argument : AnglesOf(s.run)) {
    if (!argument.of_a_body) continue;
    Scan scan{"direction: harmonics of the " + argument.name, 2};
    for (double h = 1.0; h <= std::min(6, HighestOrder(argument.angle_rad)); ++h)
      scan.Add(direction.asDiagonal() * Wave(h * argument.angle_rad), h);
    TestScan(s, scan, tests);
  }
}

/// What is left of the move after the dwell, 1 at the shortest. Its mean is taken out: plain backlash is silent.
void TestDwell(const Sample& s, const Eigen::VectorXd& direction, Tests& tests) {
  const Eigen::ArrayXd dwell_s = s.run.schedule.dwell_s;
  if (!Varies(dwell_s)) return;
  Scan scan{"direction: dwell"};
  const double weight = std::max(1.0, direction.squaredNorm());
  const double shortest_s = dwell_s.isFinite().select(dwell_s, INFINITY).minCoeff();
  for (double time_s : {0.5, 1.0, 2.0, 5.0}) {
    Eigen::VectorXd rest = Recorded((-(dwell_s - shortest_s) / time_s).exp());
    rest.array() -= direction.cwiseAbs2().dot(rest) / weight;
    scan.Add(direction.cwiseProduct(rest), time_s);
  }
  TestScan(s, scan, tests);
}

/// Error in proportion to velocity, in excess of what only its sign explains.
void TestSpeed(const Sample& s, const Eigen::VectorXd& direction, Tests& tests) {
  if (!Varies(s.run.schedule.velocity_rad_s.cwiseAbs())) return;
  Eigen::VectorXd velocity = Recorded(s.run.schedule.velocity_rad_s);
  velocity /= velocity.cwiseAbs().maxCoeff();
  velocity -= direction * (direction.dot(velocity) / std::max(1.0, direction.squaredNorm()));
  Scan scan{"direction: speed"};
  scan.Add(velocity);
  TestScan(s, scan, tests);
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

void TestHarmonics(const Sample& sample, Tests& tests) {
  for (const auto& [name, angle_rad, of_a_body] : AnglesOf(sample.run)) {
    Scan whole{"harmonics: " + name, 2};
    for (double h = 1.0; h <= HighestOrder(angle_rad); ++h) whole.Add(Wave(h * angle_rad), h);
    TestScan(sample, whole, tests);
    // Whole orders close after a turn; others need more than a turn to be told from them.
    if (!of_a_body || !(angle_rad.maxCoeff() - angle_rad.minCoeff() > 2.5 * units::kPi)) continue;
    Scan half{"half turns: " + name, 2};
    for (double h : kHalfTurnOrders) half.Add(Wave(h * angle_rad), h);
    TestScan(sample, half, tests);
  }
}

void TestDirection(const Sample& sample, Tests& tests) {
  const Eigen::VectorXd direction = PairedDirection(sample.run.schedule);
  if (direction.minCoeff() >= 0.0 || direction.maxCoeff() <= 0.0) return;
  Scan mean{"direction: mean"};
  mean.Add(direction);
  TestScan(sample, mean, tests);
  TestAround(sample, direction, tests);
  TestDwell(sample, direction, tests);
  TestSpeed(sample, direction, tests);
}

}  // namespace twinbench::diagnose::screen
