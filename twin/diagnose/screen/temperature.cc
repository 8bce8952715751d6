#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>

#include "twin/diagnose/screen/circumstances.h"
#include "twin/diagnose/screen/tests.h"
#include "twin/diagnose/screen/words.h"

namespace twinbench::diagnose::screen {
namespace {

/// Temperature with gaps closed by the value before.
Eigen::VectorXd Closed(const Eigen::VectorXd& temperature) {
  Eigen::VectorXd closed = temperature;
  double last = kNaN;
  for (double v : temperature) {
    if (std::isnan(last)) last = v;
  }
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

constexpr std::array<double, 6> kLags_s = {0.0, 300.0, 600.0, 1200.0, 2400.0, 4800.0};

void TestLevel(const Sample& s, const Eigen::VectorXd& temperature, Tests& tests) {
  Eigen::MatrixXd shapes(temperature.size(), std::ssize(kLags_s));
  ScanWords words{
      "temperature", {}, "thermal expansion or wavelength (amplitude for half the range of temperature)"};
  for (double lag_s : kLags_s) {
    shapes.col(std::ssize(words.items)) = Normalised(Lagged(temperature, s.run.schedule.time_s, lag_s));
    words.items.push_back(lag_s > 0.0 ? fmt::format("temperature with a lag of {:.0f} min", lag_s / 60.0)
                                      : std::string("temperature"));
  }
  Keep(TestScan(s, {{shapes}, 1}, words), tests);
}

/// (T - T lagged) / lag is the rate of the smoothed temperature; a plain difference would be the sensor's noise.
void TestRate(const Sample& s, const Eigen::VectorXd& temperature, Tests& tests) {
  Eigen::MatrixXd shapes(temperature.size(), 2);
  ScanWords words{
      "temperature rate", {}, "a gradient that bends something (amplitude for half the range of the rate)"};
  for (double lag_s : {300.0, 1200.0}) {
    shapes.col(std::ssize(words.items)) =
        Normalised(temperature - Lagged(temperature, s.run.schedule.time_s, lag_s));
    words.items.push_back(fmt::format("the rate of temperature, smoothed over {:.0f} min", lag_s / 60.0));
  }
  Keep(TestScan(s, {{shapes}, 1}, words), tests);
}

}  // namespace

Tests TestTemperature(const Sample& sample) {
  const Schedule& schedule = sample.run.schedule;
  Tests tests;
  if (!Varies(schedule.temperature_degC) || !Varies(schedule.time_s)) return tests;
  const Eigen::VectorXd temperature = Closed(schedule.temperature_degC);
  TestLevel(sample, temperature, tests);
  TestRate(sample, temperature, tests);
  return tests;
}

}  // namespace twinbench::diagnose::screen
