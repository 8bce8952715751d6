#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "twin/diagnose/screen/circumstances.h"
#include "twin/diagnose/screen/tests.h"
#include "twin/diagnose/screen/words.h"

namespace twinbench::diagnose::screen {
namespace {

constexpr int kMostTones = 800;

/// Up to the Nyquist frequency of the median interval, steps of at most half a cycle over the run unless that is
/// too many.
std::vector<double> Frequencies_hz(const Eigen::VectorXd& time_s) {
  std::vector<double> interval_s;
  for (Eigen::Index i = 1; i < time_s.size(); ++i) interval_s.push_back(time_s[i] - time_s[i - 1]);
  std::nth_element(interval_s.begin(), interval_s.begin() + std::ssize(interval_s) / 2, interval_s.end());
  const double median_s = interval_s[interval_s.size() / 2];
  const double nyquist_hz = 0.5 / median_s, duration_s = time_s.maxCoeff() - time_s.minCoeff();
  const int tones = std::clamp(static_cast<int>(std::ceil(2.0 * nyquist_hz * duration_s)), 1, kMostTones);
  std::vector<double> frequency_hz;
  for (int k = 1; k <= tones; ++k) frequency_hz.push_back(nyquist_hz * k / tones);
  return frequency_hz;
}

std::string ToneWords(double frequency_hz) {
  return fmt::format("a tone of {:.3g} mHz (period {:.4g} s)", 1e3 * frequency_hz, 1.0 / frequency_hz);
}

}  // namespace

/// Cosine and sine in time, least squares on uneven times (Lomb 1976, Scargle 1982) beside the free unknowns.
Tests TestTones(const Sample& sample) {
  const Eigen::VectorXd& time_s = sample.run.schedule.time_s;
  if (time_s.size() < 8 || !Varies(time_s)) return {};
  Scan scan{{}, 2};
  ScanWords words{"time: tone", {}, "hum or vibration aliased by the stops, an air conditioner's cycle"};
  const std::vector<double> frequency_hz = Frequencies_hz(time_s);
  Eigen::MatrixXd shapes(time_s.size(), 2 * std::ssize(frequency_hz));
  for (double f : frequency_hz) {
    const auto at = 2 * std::ssize(words.items);
    const Eigen::ArrayXd phase = 2.0 * std::numbers::pi * f * (time_s.array() - time_s[0]);
    shapes.col(at) = phase.cos();
    shapes.col(at + 1) = phase.sin();
    words.items.push_back(ToneWords(f));
  }
  scan.shapes.push_back(std::move(shapes));
  Tests tests;
  Keep(TestScan(sample, scan, words), tests);
  return tests;
}

}  // namespace twinbench::diagnose::screen
