#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace twinbench::sim {

/// How moving air leads a beam astray, in one direction: normal noise with the power spectral density
///
///     S(f) ~ f^(-2/3) / (1 + (f / corner)^2)    from a thousandth of the corner to ten times the corner,
///
/// that of the angle at which light arrives on an aperture behind frozen Kolmogorov turbulence that a wind carries
/// by: f^(-2/3) below, f^(-8/3) above wind speed over aperture. A sum of sinusoids with phases from the seed, which
/// can be asked at any time, in any order.
/// Reference: Clifford, J. Opt. Soc. Am. 61 (1971) 1285-1292 (spectra of phase differences).
class BeamWander {
 public:
  /// @param rms   In the unit that At gives; not 0.
  /// @param name  Of its random stream.
  BeamWander(double rms, double corner_Hz, std::uint64_t seed, const std::string& name);

  double At(double time_s) const;
  /// Period of its fastest line.
  double Shortest_s() const { return 1.0 / (kHighest * corner_Hz_); }

  static constexpr double kLowest = 1e-3, kHighest = 10.0;  // of the corner

 private:
  struct Line {
    double amplitude, rate_rad_s, phase_rad;
  };

  double corner_Hz_;
  std::vector<Line> lines_;
};

}  // namespace twinbench::sim
