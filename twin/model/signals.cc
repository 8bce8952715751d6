#include "twin/model/signals.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "twin/core/distributions.h"
#include "twin/core/units.h"
#include "twin/model/first_order_lag.h"

namespace twinbench::model {

Eigen::MatrixXd Times(const Eigen::MatrixXd& columns, const Eigen::VectorXd& factor) {
  return columns.array().colwise() * factor.array();
}

double Rms(const Eigen::VectorXd& signal) {
  return std::sqrt(signal.squaredNorm() / static_cast<double>(std::max<Eigen::Index>(1, signal.size())));
}

Eigen::VectorXd Unit(const Eigen::VectorXd& signal) {
  const double rms = Rms(signal);
  return rms > 0.0 ? Eigen::VectorXd(signal / rms) : signal;
}

Eigen::MatrixXd Indicators(const std::vector<int>& label) {
  const std::set<int> values(label.begin(), label.end());
  Eigen::MatrixXd indicators = Eigen::MatrixXd::Zero(std::ssize(label), std::ssize(values));
  for (std::size_t i = 0; i < label.size(); ++i)
    indicators(static_cast<Eigen::Index>(i), std::distance(values.begin(), values.find(label[i]))) = 1.0;
  return indicators;
}

Eigen::MatrixXd InEach(const Eigen::MatrixXd& columns, const Eigen::MatrixXd& indicators) {
  Eigen::MatrixXd all(columns.rows(), columns.cols() * indicators.cols());
  for (Eigen::Index k = 0; k < indicators.cols(); ++k)
    all.middleCols(k * columns.cols(), columns.cols()) = Times(columns, indicators.col(k));
  return all;
}

std::vector<int> Visits(const Course& course) {
  constexpr int kMostPasses = 100000;
  std::vector<int> visits;
  for (std::size_t i = 0; i < course.pass.size(); ++i)
    visits.push_back(kMostPasses * course.setup[i] + course.pass[i]);
  return visits;
}

Eigen::MatrixXd Wave(const Eigen::VectorXd& phase_rad) {
  Eigen::MatrixXd wave(phase_rad.size(), 2);
  wave << phase_rad.array().cos().matrix(), phase_rad.array().sin().matrix();
  return wave;
}

Eigen::VectorXd ElapsedShare(const Course& course) {
  const double first_s = course.time_s.minCoeff();
  return (course.time_s.array() - first_s) / std::max(course.time_s.maxCoeff() - first_s, 1e-6);
}

Eigen::MatrixXd Drift_s(const Eigen::VectorXd& time_s) {
  Eigen::MatrixXd drift(time_s.size(), 2);
  drift << time_s, (time_s.array() * (1.0 - time_s.array() / units::hour)).matrix();
  return drift;
}

Eigen::MatrixXd Tone(const Eigen::VectorXd& time_s, double frequency_Hz) {
  return Wave(2.0 * units::kPi * frequency_Hz * time_s);
}

Eigen::VectorXd Step(const std::vector<int>& reading, double at_reading) {
  Eigen::VectorXd step(std::ssize(reading));
  for (Eigen::Index i = 0; i < step.size(); ++i)
    step[i] = std::clamp(reading[static_cast<std::size_t>(i)] - at_reading + 1.0, 0.0, 1.0);
  return step;
}

Eigen::MatrixXd CosineModes(const Eigen::VectorXd& share, int count, bool falling) {
  Eigen::MatrixXd modes(share.size(), count);
  for (int k = 1; k <= count; ++k)
    modes.col(k - 1) = (k * units::kPi * share.array()).cos() / (falling ? static_cast<double>(k) : 1.0);
  return modes;
}

Eigen::VectorXd SinceFirst_s(const Course& course) {
  Eigen::VectorXd since_s(course.Readings());
  double first_s = 0.0;
  for (Eigen::Index i = 0; i < since_s.size(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (i == 0 || course.setup[at] != course.setup[at - 1] || course.phase[at] != course.phase[at - 1])
      first_s = course.time_s[i];
    since_s[i] = course.time_s[i] - first_s;
  }
  return since_s;
}

bool HasTemperature(const Course& course) {
  return course.temperature_degC.array().isFinite().any();
}

Eigen::VectorXd Above_K(const Course& course, double reference_degC) {
  Eigen::VectorXd above_K(course.Readings());
  double last_K = 0.0;
  for (Eigen::Index i = 0; i < above_K.size(); ++i) {
    if (std::isfinite(course.temperature_degC[i])) last_K = course.temperature_degC[i] - reference_degC;
    above_K[i] = last_K;
  }
  return above_K;
}

Eigen::VectorXd Lagged(const Eigen::VectorXd& time_s, const Eigen::VectorXd& followed, double lag_s) {
  FirstOrderLag lag(lag_s);
  Eigen::VectorXd lagged(followed.size());
  for (Eigen::Index i = 0; i < lagged.size(); ++i) lagged[i] = lag.Next(time_s[i], followed[i]);
  return lagged;
}

Eigen::VectorXd HeldDirection(const Course& course) {
  const auto moving = std::ranges::find_if(course.direction, [](int d) { return d != 0; });
  double last = moving == course.direction.end() ? 0.0 : *moving;
  Eigen::VectorXd held(course.Readings());
  for (Eigen::Index i = 0; i < held.size(); ++i) {
    const int direction = course.direction[static_cast<std::size_t>(i)];
    if (direction != 0) last = direction;
    held[i] = last;
  }
  return held;
}

double TypicalStep_rad(const Course& course, const Eigen::VectorXd& angle_rad) {
  std::vector<double> steps_rad;
  for (Eigen::Index i = 1; i < angle_rad.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double step_rad = std::abs(angle_rad[i] - angle_rad[i - 1]);
    if (course.pass[k] == course.pass[k - 1] && step_rad > 0.0) steps_rad.push_back(step_rad);
  }
  return steps_rad.empty() ? 0.0 : Median(std::move(steps_rad));
}

int HighestOrder(double step_rad, int most) {
  if (!(step_rad > units::kPi / (most + 1.0))) return step_rad > 0.0 ? most : 0;
  return static_cast<int>(std::ceil(units::kPi / step_rad - 1e-6)) - 1;
}

}  // namespace twinbench::model
