#pragma once

#include <complex>
#include <string>
#include <vector>

#include "mechanics/base_response.h"
#include "mechanics/plant.h"
#include "twin/core/time.h"

/// The floor that the bench stands on, and what the stack makes of it.
namespace twinbench::sim {

/// Root mean square velocity in one third-octave band.
struct VibrationBand {
  double centre_Hz = 0.0;
  double velocity_m_s = 0.0;
};

/// Bands of a vibration criterion curve "VC-A" (50 um/s) to "VC-G" (0.78 um/s), 1 to 80 Hz: constant velocity; A
/// and B from 8 Hz down to 4 Hz constant acceleration, and nothing below. Reference: IEST-RP-CC012; C. G. Gordon,
/// Proc. SPIE 1619 (1991) 71-85, and 3786 (1999) 22-33.
/// @throws std::invalid_argument for another name.
std::vector<VibrationBand> VibrationCriterion(const std::string& name);

/// A sum of sinusoids, three in every band (one in each third of it) and each along all three axes with phases of
/// their own, drawn from the seed. So it can be asked at any time, in any order, and in every band and along every
/// axis its root mean square is the stated one.
class BaseVibration {
 public:
  struct Line {
    double frequency_Hz;
    Eigen::Vector3cd acceleration_m_s2;  // x, y, z of the laboratory; of exp(i 2 pi f t), whose real part counts
  };

  BaseVibration(const std::vector<VibrationBand>& bands, std::uint64_t seed);

  const std::vector<Line>& lines() const { return lines_; }

 private:
  std::vector<Line> lines_;
};

/// What the vibration adds to the state of a stack, seen from the base where laser and detectors stand. It is the
/// steady linear answer (RespondToBase) on top of whatever moves or rests: some nanometres, for which the bodies'
/// equations are linear to 1e-8, so a plant that sleeps shows it like one that moves.
class ShakenStack {
 public:
  ShakenStack(const mechanics::StackParameters& parameters, const BaseVibration& vibration);

  /// Adds deflections and servo errors at `time` to the state.
  void AddTo(mechanics::StackState& state, Time time);
  /// As AddTo goes on with other mountings.
  void Mount(const mechanics::ChainGeometry& geometry) { parameters_.geometry = geometry; }

 private:
  using Amplitude = Eigen::Matrix<std::complex<double>, mechanics::kCoordinates, 1>;
  struct Line {
    double rate_rad_s;
    Eigen::Vector3cd acceleration_m_s2;
    mechanics::ComplexResponse response;
    Amplitude amplitude;  // in the payload's axes as they stand
  };

  void Face(double azimuth_rad);

  mechanics::StackParameters parameters_;
  std::vector<Line> lines_;
  double azimuth_rad_;
};

}  // namespace twinbench::sim
