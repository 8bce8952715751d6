#pragma once

#include <cmath>
#include <functional>
#include <random>
#include <vector>

/// An axis under a reference and a device that errs, made with nothing of the program's: the raw files of these
/// tests are printed from it.
namespace twinbench::test {

struct AxisSample {
  double time_s = 0.0, angle_deg = 0.0, shown_deg = 0.0;
  int sense = 1;
};

/// What a device shows too much, by its angle and the sense of the motion.
using AxisError = std::function<double(double angle_deg, int sense)>;

struct AxisMotion {
  double turns = 1.0, speed_deg_s = 20.0, interval_s = 0.05, rest_s = 0.5;
  std::vector<int> passes = {1, -1, 1, -1};
  double noise_deg = 0.002;
  unsigned seed = 1;
};

inline double Cosine(double order, double angle_deg, double phase_deg) {
  return std::cos((order * angle_deg + phase_deg) * 3.14159265358979323846 / 180.0);
}

/// Passes at constant speed, each followed by a rest.
inline std::vector<AxisSample> DriveAxis(const AxisMotion& motion, const AxisError& error) {
  std::mt19937_64 random(motion.seed);
  std::normal_distribution<double> noise(0.0, motion.noise_deg);
  std::vector<AxisSample> samples;
  double time_s = 0.0, angle_deg = 0.0;
  const auto add = [&](int sense) {
    samples.push_back({time_s, angle_deg, angle_deg + error(angle_deg, sense) + noise(random), sense});
    time_s += motion.interval_s;
  };
  const double step_deg = motion.speed_deg_s * motion.interval_s;
  for (const int sense : motion.passes) {
    for (int i = 0; i < std::lround(motion.turns * 360.0 / step_deg); ++i) {
      angle_deg += sense * step_deg;
      add(sense);
    }
    for (int i = 0; i < std::lround(motion.rest_s / motion.interval_s); ++i) add(sense);
  }
  return samples;
}

inline double OnceRound(double angle_deg) {
  return angle_deg - 360.0 * std::floor(angle_deg / 360.0);
}

}  // namespace twinbench::test
