#pragma once

#include <cmath>
#include <random>

#include "tests/separate/waves.h"
#include "twin/separate/index_errors.h"

/// A table with lines where gears, drives and bearings have them, read against teeth: written down anew here, so
/// that it shares nothing with the twin.
namespace twinbench::separate {

using test::ValueOf, test::Wave;

/// Eccentricity and ovality of the rings, and `gears` lines up to order 200.
inline std::vector<Wave> DrawSpectrum(std::mt19937_64& random, int gears) {
  constexpr int kGearOrders[] = {12, 18, 23, 30, 45, 54, 60, 72, 90, 99, 120, 126, 144, 150, 180, 198, 200};
  std::uniform_real_distribution<double> uniform;
  std::vector<Wave> lines;
  const auto add = [&](int order, double least_arcsec, double most_arcsec) {
    const double amplitude_arcsec = least_arcsec + (most_arcsec - least_arcsec) * uniform(random);
    lines.push_back({order, amplitude_arcsec, 2.0 * units::kPi * uniform(random)});
  };
  add(1, 4.0, 9.0);
  add(2, 1.5, 4.0);
  add(3, 0.5, 2.0);
  for (int k = 0; k < gears; ++k) add(kGearOrders[random() % std::size(kGearOrders)], 0.3, 1.5);
  return lines;
}

struct ReadingPlan {
  std::vector<double> angles_deg;
  std::vector<int> setups;  // one entry a pass
};

/// Every angle of a plan in every pass: the table's error where the controller sends it, the tooth's, and noise.
struct SpectrumBench {
  std::vector<Wave> lines;
  std::vector<double> tooth_rad;            // one a degree
  double noise_rad = 0.39 * units::arcsec;  // 0.3 of the table's repeatability, 0.25 of the autocollimator
  mutable std::mt19937_64 random{1};
  std::optional<CompensationTable> commanded = {};

  IndexErrors Read(const std::vector<ReadingPlan>& plans) const {
    std::normal_distribution<double> normal;
    std::vector<IndexReading> readings;
    for (const ReadingPlan& plan : plans) {
      for (const int setup : plan.setups) {
        for (const double angle_deg : plan.angles_deg) {
          const double angle_rad = angle_deg * units::deg;
          const double sent_rad = CommandedAngle_rad(commanded, angle_rad);
          const double tooth = tooth_rad[static_cast<std::size_t>(std::lround(angle_deg)) % tooth_rad.size()];
          readings.push_back({setup, angle_rad,
                              sent_rad - angle_rad + ValueOf(lines, sent_rad) + tooth + setup * 1e-4 +
                                  noise_rad * normal(random)});
        }
      }
    }
    IndexErrors errors = MeansByPlace(readings);
    errors.table = "turntable";
    errors.u_place_rad = 0.15 * units::arcsec;
    errors.commanded = commanded;
    return errors;
  }
};

inline SpectrumBench DrawBench(std::uint64_t seed, int gears) {
  std::normal_distribution<double> normal;
  SpectrumBench bench;
  bench.random.seed(seed);
  bench.lines = DrawSpectrum(bench.random, gears);
  for (int tooth = 0; tooth < 360; ++tooth) bench.tooth_rad.push_back(0.1 * units::arcsec * normal(bench.random));
  return bench;
}

/// Without teeth, with just these lines.
inline SpectrumBench BenchWith(const std::vector<Wave>& lines, double noise_rad, std::uint64_t seed = 1) {
  return {lines, std::vector<double>(360, 0.0), noise_rad, std::mt19937_64(seed)};
}

/// 72 positions in two set-ups, there and back.
inline ReadingPlan EvenPositions() {
  ReadingPlan plan{{}, {0, 0, 1, 1}};
  for (int k = 0; k < 72; ++k) plan.angles_deg.push_back(5.0 * k);
  return plan;
}

/// The degrees between them, `step`-th of each, there and back in the last set-up.
inline ReadingPlan Between(int step) {
  ReadingPlan plan{{}, {1, 1}};
  int next = 0;
  for (int degree = 0; degree < 360; ++degree) {
    if (degree % 5 != 0 && next++ % step == 0) plan.angles_deg.push_back(degree);
  }
  return plan;
}

}  // namespace twinbench::separate
