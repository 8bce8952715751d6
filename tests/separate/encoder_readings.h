#pragma once

#include <functional>

#include "tests/separate/waves.h"
#include "twin/core/reading.h"
#include "twin/core/stream.h"

/// Readings of an angle comparison from closed forms, independent of the twin.
namespace twinbench::test {

/// Largest error of those orders that are seen [arcsec].
inline double WorstOrder_arcsec(const harmonics::HarmonicSeries& series, const std::vector<Wave>& waves) {
  double worst = 0.0;
  for (int k = 1; k <= series.Highest(); ++k) {
    if (std::isfinite(series.At(k).value.real()))
      worst = std::max(worst, std::abs(series.At(k).value - CoefficientOf(waves, k)) / units::arcsec);
  }
  return worst;
}

/// Chi-squared / 2 of one order.
inline double OrderChi2(const harmonics::HarmonicSeries& series, const std::vector<Wave>& waves, int k) {
  return 0.5 * Pull2(series.At(k), CoefficientOf(waves, k));
}

/// Mean of that over the orders that are seen.
inline double MeanOrderChi2(const harmonics::HarmonicSeries& series, const std::vector<Wave>& waves) {
  double sum = 0.0;
  int count = 0;
  for (int k = 1; k <= series.Highest(); ++k) {
    if (!std::isfinite(series.At(k).value.real())) continue;
    sum += OrderChi2(series, waves, k);
    ++count;
  }
  return sum / count;
}

/// A device on the shaft of a reference: stops at even angles, each pass through all turns.
struct Comparison {
  std::vector<Wave> device = {}, reference = {};
  std::vector<Wave> backward = {};  // what the device has more when it goes backwards
  double reversal_arcsec = 0.0;     // constant part of forward - backward
  std::vector<double> mounting_rad = {0.0};
  std::vector<int> passes = {1, -1, -1, 1};
  int stops = 72;
  double turns = 2.0;
  double noise_arcsec = 0.0;
  std::uint64_t seed = 1;
  std::function<double(int, int)> drift_arcsec = {};  // by running number and set-up, if there is any
  std::function<double(int)> jitter_rad = {};         // of the stop, by its index
  std::function<bool(int)> missing = {};              // by running number

  std::vector<Reading> Readings() const {
    Stream stream(seed, "test.noise");
    std::vector<Reading> readings;
    int pass = 0;
    for (std::size_t s = 0; s < mounting_rad.size(); ++s) {
      for (const int direction : passes) AddPass(static_cast<int>(s), pass++, direction, stream, readings);
    }
    return readings;
  }

 private:
  void AddPass(int setup, int pass, int direction, Stream& stream, std::vector<Reading>& readings) const {
    const int count = static_cast<int>(std::lround(stops * turns));
    for (int k = 0; k < count; ++k) {
      Reading r{.reading = static_cast<int>(readings.size())};
      r.time = Time(FromSeconds(r.reading));
      r.setup = setup;
      r.pass = pass;
      r.direction = direction;
      r.position = direction > 0 ? k : count - 1 - k;
      r.velocity_rad_s = 0.0;
      const double shaft =
          0.02 + 2.0 * units::kPi * r.position / stops + (jitter_rad ? jitter_rad(r.position) : 0.0);
      const double angle = shaft + mounting_rad[static_cast<std::size_t>(setup)];
      r.reference_rad = shaft + ValueOf(reference, shaft);
      r.measured_rad = angle + ValueOf(device, angle) + noise_arcsec * units::arcsec * stream.Normal();
      r.measured_rad += 0.5 * direction * reversal_arcsec * units::arcsec;
      if (direction < 0) r.measured_rad += ValueOf(backward, angle);
      if (drift_arcsec) r.measured_rad += drift_arcsec(r.reading, setup) * units::arcsec;
      if (missing && missing(r.reading)) r.measured_rad = kNaN, r.status = ReadingStatus::kMissing;
      readings.push_back(r);
    }
  }
};

}  // namespace twinbench::test
