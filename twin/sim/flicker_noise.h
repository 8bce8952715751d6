#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace twinbench::sim {

/// Noise whose power spectral density falls as 1 / f: a sum of sinusoids, ten in every decade from 0.1 mHz (three
/// hours) to 100 Hz, all of one amplitude, with phases from the seed. Every decade adds the same variance. It can
/// be asked at any time, in any order.
class FlickerNoise {
 public:
  /// @param sd_a_decade  Standard deviation of what one decade of frequencies adds; 0: none.
  /// @param name         Of its random stream.
  FlickerNoise(double sd_a_decade, std::uint64_t seed, const std::string& name);

  double At(double time_s) const;

  /// Period of its fastest line; infinite if there is no noise.
  double Shortest_s() const { return lines_.empty() ? std::numeric_limits<double>::infinity() : kShortest_s; }

 private:
  static constexpr double kShortest_s = 0.01;
  struct Line {
    double rate_rad_s, phase_rad;
  };

  double amplitude_;
  std::vector<Line> lines_;
};

}  // namespace twinbench::sim
