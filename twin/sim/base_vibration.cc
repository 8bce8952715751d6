#include "twin/sim/base_vibration.h"

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "mechanics/stack_propagator.h"
#include "twin/core/stream.h"
#include "twin/core/units.h"

namespace twinbench::sim {
namespace {

using mechanics::kCoordinates, mechanics::SpinIndex;

struct Criterion {
  const char* name;
  double velocity_m_s;
  bool eases_below_8_Hz;
};
constexpr std::array<Criterion, 7> kCriteria = {{{"VC-A", 50e-6, true},
                                                 {"VC-B", 25e-6, true},
                                                 {"VC-C", 12.5e-6, false},
                                                 {"VC-D", 6.25e-6, false},
                                                 {"VC-E", 3.12e-6, false},
                                                 {"VC-F", 1.56e-6, false},
                                                 {"VC-G", 0.78e-6, false}}};
constexpr int kBands = 20;             // 10^(n/10) Hz, n = 0 to 19: 1 to 80 Hz
constexpr double kBand_decades = 0.1;  // width of a third octave, by IEC 61260-1
constexpr int kLinesABand = 3;

std::complex<double> Unit(double phase_rad) {
  return {std::cos(phase_rad), std::sin(phase_rad)};
}

}  // namespace

std::vector<VibrationBand> VibrationCriterion(const std::string& name) {
  for (const Criterion& c : kCriteria) {
    if (name != c.name) continue;
    std::vector<VibrationBand> bands;
    for (int n = c.eases_below_8_Hz ? 6 : 0; n < kBands; ++n) {
      const double centre_Hz = std::pow(10.0, kBand_decades * n);
      const bool eased = c.eases_below_8_Hz && n < 9;  // 4, 5 and 6.3 Hz
      bands.push_back({centre_Hz, c.velocity_m_s * (eased ? 8.0 / centre_Hz : 1.0)});
    }
    return bands;
  }
  throw std::invalid_argument("vibration: \"" + name + "\" is none of VC-A to VC-G");
}

BaseVibration::BaseVibration(const std::vector<VibrationBand>& bands, std::uint64_t seed) {
  Stream stream(seed, "base.vibration");
  for (const VibrationBand& band : bands) {
    const double velocity_m_s = band.velocity_m_s * std::sqrt(2.0 / kLinesABand);  // amplitude of one line
    for (int i = 0; i < kLinesABand; ++i) {
      const double in_band = (i + stream.Uniform()) / kLinesABand - 0.5;
      Line line{band.centre_Hz * std::pow(10.0, kBand_decades * in_band), Eigen::Vector3cd::Zero()};
      const double rate_rad_s = 2.0 * units::kPi * line.frequency_Hz;
      for (int axis = 0; axis < 3; ++axis) {
        line.acceleration_m_s2[axis] = rate_rad_s * velocity_m_s * Unit(2.0 * units::kPi * stream.Uniform());
      }
      lines_.push_back(line);
    }
  }
}

ShakenStack::ShakenStack(const mechanics::StackParameters& parameters, const BaseVibration& vibration)
    : parameters_(parameters) {
  for (const BaseVibration::Line& line : vibration.lines()) {
    lines_.push_back({2.0 * units::kPi * line.frequency_Hz, line.acceleration_m_s2,
                      mechanics::RespondToBase(parameters, line.frequency_Hz), Amplitude::Zero()});
  }
  azimuth_rad_ = std::numeric_limits<double>::quiet_NaN();
  Face(0.0);
}

/// Turns the base's motion into the payload's axes, in which the answers stand.
void ShakenStack::Face(double azimuth_rad) {
  if (azimuth_rad == azimuth_rad_) return;
  azimuth_rad_ = azimuth_rad;
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(-azimuth_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  for (Line& line : lines_) {
    line.amplitude = line.response * (turn.cast<std::complex<double>>() * line.acceleration_m_s2);
  }
}

void ShakenStack::AddTo(mechanics::StackState& state, Time time) {
  const double payload_rad = mechanics::PayloadAzimuths(parameters_, state.target_rad, state.reference_rad)[0];
  Face(payload_rad);
  mechanics::Vector12 sum = mechanics::Vector12::Zero();
  for (const Line& line : lines_) {
    const std::complex<double> phasor = Unit(line.rate_rad_s * ToSeconds(time));
    sum += phasor.real() * line.amplitude.real() - phasor.imag() * line.amplitude.imag();
  }
  const double body_rad = state.target_rad + parameters_.geometry.reseat_rad;  // of the reference in the laboratory
  sum = mechanics::Turned(sum, {payload_rad, payload_rad - body_rad});
  state.target_bearing = state.target_bearing + mechanics::BearingOf(sum, 0);
  state.reference_bearing = state.reference_bearing + mechanics::BearingOf(sum, 1);
  state.target_rad += sum[SpinIndex(0)];
  state.target_encoder_rad += sum[SpinIndex(0)];
  state.reference_rad += sum[SpinIndex(1)];
  state.reference_encoder_rad += sum[SpinIndex(1)];
}

}  // namespace twinbench::sim
