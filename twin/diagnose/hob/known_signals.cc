#include "twin/diagnose/hob/known_signals.h"

#include <cmath>
#include <map>

#include "twin/core/units.h"

namespace twinbench::diagnose::hob {
namespace {

Eigen::VectorXd Harmonics_rad(const std::vector<HarmonicSettings>& harmonics, const Eigen::VectorXd& angle_rad) {
  Eigen::VectorXd sum_rad = Eigen::VectorXd::Zero(angle_rad.size());
  for (const HarmonicSettings& h : harmonics)
    sum_rad.array() += h.amplitude * (h.order * angle_rad.array() + h.phase_rad).cos();
  return sum_rad;
}

/// What a ring's head shows too much, by the ring's own angle s. Azimuths on the ring run against s: the line under
/// the head has the azimuth -s. A head above or below the middle plane sees a tilted ring aside.
Eigen::VectorXd RingError_rad(const RingEncoderSettings& ring, const Eigen::VectorXd& s_rad) {
  const double aside_m = ring.head_height_m * ring.tilt_rad;
  const auto s = s_rad.array();
  return (ring.eccentricity_m * (s + ring.eccentricity_azimuth_rad).sin() -
          aside_m * (s + ring.tilt_azimuth_rad).cos() +
          0.5 * ring.ellipticity_m * (2.0 * (s + ring.ellipticity_azimuth_rad)).sin())
                 .matrix() /
             ring.radius_m +
         Harmonics_rad(ring.graduation, s_rad);
}

Eigen::VectorXd Empirical_rad(const EmpiricalSettings& signal, const std::vector<int>& readings) {
  std::map<int, double> by_reading;
  for (std::size_t k = 0; k < signal.reading.size(); ++k) by_reading[signal.reading[k]] = signal.value_rad[k];
  Eigen::VectorXd values_rad = Eigen::VectorXd::Zero(std::ssize(readings));
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const auto found = by_reading.find(readings[i]);
    if (found != by_reading.end()) values_rad[static_cast<Eigen::Index>(i)] = found->second;
  }
  return values_rad;
}

}  // namespace

SampleSignal& SampleSignal::operator+=(const SampleSignal& other) {
  encoders_rad += other.encoders_rad;
  interferometer_rad += other.interferometer_rad;
  return *this;
}

SampleSignal StatedSignal(const Scenario& scenario, const SignalContext& c) {
  const TransmissionSettings& t = scenario.transmission;
  const double behind_rad = t.friction_Nm / t.stiffness_Nm_rad + 0.5 * t.backlash_rad;
  const double lag_s = (1.0 - t.feed_forward) / (2.0 * units::kPi * t.servo_Hz);
  const Eigen::VectorXd motion_rad =
      Harmonics_rad(t.harmonics, c.table_rad) - behind_rad * c.direction - lag_s * c.velocity_rad_s;
  const Eigen::VectorXd rings_rad = RingError_rad(scenario.table_encoder, c.ring_rad) -
                                    t.Ratio() * RingError_rad(scenario.hob_encoder, c.hob_rad);
  return {motion_rad + rings_rad, motion_rad};
}

SampleSignal KnownSignal(const Scenario& scenario, const SignalContext& context) {
  SampleSignal known = StatedSignal(scenario, context);
  for (const EffectSettings& effect : scenario.effects) known += EffectSignal(effect, context);
  for (const EmpiricalSettings& signal : scenario.empiricals)
    known.encoders_rad += Empirical_rad(signal, context.schedule.reading);
  return known;
}

}  // namespace twinbench::diagnose::hob
