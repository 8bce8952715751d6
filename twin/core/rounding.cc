#include "twin/core/rounding.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "twin/core/units.h"

namespace twinbench {
namespace {

/// Of the wave k of a saw-tooth of steps of 1 in the mean of noisy readings: half the square of its amplitude.
double WavePower(int k, double noise) {
  return std::exp(-std::pow(2.0 * units::kPi * k * noise, 2)) / (2.0 * std::pow(units::kPi * k, 2));
}

/// Distances of neighbours in size that are more than rounding.
std::vector<double> GapsOf(std::vector<double> values, double rounding) {
  std::ranges::sort(values);
  std::vector<double> gaps;
  for (std::size_t i = 1; i < values.size(); ++i) {
    if (values[i] - values[i - 1] > rounding) gaps.push_back(values[i] - values[i - 1]);
  }
  return gaps;
}

/// Every reading one step further: the positions were chosen so, and nothing was rounded.
bool IsEven(const Eigen::VectorXd& values, double step) {
  constexpr double kMostOther = 0.05;  // of the readings
  Eigen::Index other = 0;
  for (Eigen::Index i = 1; i < values.size(); ++i)
    other += std::abs(std::abs(values[i] - values[i - 1]) / step - 1.0) > 0.1 ? 1 : 0;
  return static_cast<double>(other) < kMostOther * static_cast<double>(values.size());
}

/// A last digit of an angle in a usual unit, or of any other value: what is even by design is no print.
bool IsDigit(double step) {
  constexpr double kSame = 1e-3;
  return std::ranges::any_of(std::array{1.0, units::deg, units::arcsec, units::mrad}, [step](double unit) {
    const double digits = std::log10(step / unit);
    return std::abs(digits - std::round(digits)) < kSame;
  });
}

/// Of values that were printed with few digits: all gaps are whole steps but for that, none is as small.
/// @param gaps  Of values in their order, ascending.  @param print  The last digit.
double PrintedStep(const std::vector<double>& gaps, double print) {
  constexpr double kCoarse = 10.0, kOff = 1.5;  // prints
  constexpr double kMostOff = 0.01;          // of the gaps
  constexpr int kRounds = 4;
  double step = *std::ranges::min_element(gaps);
  if (!IsDigit(print) || step < kCoarse * print) return 0.0;
  for (const double difference : GapsOf(gaps, kCoarse * print)) step = std::min(step, difference);
  for (int round = 0; round < kRounds; ++round) {
    double way = 0.0, steps = 0.0;
    for (const double gap : gaps) {
      way += gap;
      steps += std::round(gap / step);
    }
    step = way / steps;
  }
  const auto off = std::ranges::count_if(gaps, [&](double gap) { return std::abs(gap - step * std::round(gap / step)) > kOff * print; });
  return static_cast<double>(off) <= kMostOff * static_cast<double>(gaps.size()) ? step : 0.0;
}

/// @param same  Values that differ by less are one.
double CommonStepOf(const Eigen::VectorXd& values, double same) {
  constexpr std::size_t kFewestGaps = 16;
  const std::vector<double> gaps = GapsOf({values.begin(), values.end()}, same);
  if (gaps.size() < kFewestGaps) return 0.0;
  double least = *std::ranges::min_element(gaps);
  for (const double difference : GapsOf(gaps, 2.0 * same)) least = std::min(least, difference);
  constexpr double kOff = 0.05, kMostOff = 0.01;  // of a step; of the gaps
  for (const double parts : {1.0, 2.0, 3.0, 4.0}) {
    const double step = least / parts;
    const auto off = std::ranges::count_if(
        gaps, [step](double gap) { return std::abs(gap / step - std::round(gap / step)) > kOff; });
    if (static_cast<double>(off) > kMostOff * static_cast<double>(gaps.size())) continue;
    const double printed = PrintedStep(gaps, step);
    if (printed > 0.0 && !IsEven(values, printed)) return printed;
    return IsEven(values, step) ? 0.0 : step;
  }
  return 0.0;
}

}  // namespace

double CommonStep(const Eigen::VectorXd& values) {
  // Of a file with ten significant digits, whose last one goes with the size of the value; of computed values.
  for (const double relative : {1e-8, 1e-11}) {
    const double step = CommonStepOf(values, relative * values.cwiseAbs().maxCoeff());
    if (step > 0.0) return step;
  }
  return 0.0;
}

double RepeatedByRounding(double noise) {
  constexpr int kWaves = 100;
  double sum = 0.0;
  for (int k = 1; k <= kWaves; ++k) sum += WavePower(k, noise);
  return sum;
}

RoundingInMean RoundingOf(double step, double noise, double count) {
  const double of_one = step * step / 12.0;
  const double repeated = count > 1.0 && step > 0.0 ? step * step * RepeatedByRounding(noise / step) : of_one;
  return {repeated, repeated + (of_one - repeated) / count};
}

double LargestByRounding(double step, double scatter) {
  if (!(step > 0.0)) return 0.0;
  const double noise2 = std::max(0.0, scatter * scatter - step * step / 12.0) / (step * step);
  return step / std::sqrt(12.0) * std::exp(-2.0 * units::kPi * units::kPi * noise2);
}

double NoiseBehindRounding(double step, double scatter) {
  if (!(step > 0.0)) return scatter;
  const double seen = std::pow(scatter / step, 2);
  const auto shown = [](double noise) { return noise * noise + 1.0 / 12.0 - RepeatedByRounding(noise); };
  double low = 0.0, high = scatter / step;
  constexpr int kHalvings = 40;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = 0.5 * (low + high);
    (shown(middle) < seen ? low : high) = middle;
  }
  return low * step;
}

Eigen::MatrixXd RoundingWaves(const Eigen::VectorXd& values, double step, double noise) {
  constexpr int kWaves = 12;  // 95 % of a saw-tooth
  Eigen::MatrixXd waves(values.size(), 2 * kWaves);
  double power = 0.0;
  for (int k = 1; k <= kWaves; ++k) {
    const Eigen::ArrayXd phase_rad = units::turn * k * (values.array() / step - (values.array() / step).round());
    const double size = std::sqrt(WavePower(k, noise / step));
    waves.col(2 * k - 2) = size * phase_rad.cos();
    waves.col(2 * k - 1) = size * phase_rad.sin();
    power += size * size;
  }
  return power > 0.0 ? Eigen::MatrixXd(step * std::sqrt(RepeatedByRounding(noise / step) / power) * waves) : waves;
}

}  // namespace twinbench
