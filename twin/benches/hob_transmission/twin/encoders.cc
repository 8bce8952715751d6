#include "twin/benches/hob_transmission/twin/encoders.h"

#include <cmath>

#include "twin/benches/hob_transmission/settings.h"

namespace twinbench::sim {
namespace {

mechanics::Ring RingOf(const RingEncoderSettings& s) {
  mechanics::Ring ring;
  ring.radius_m = s.radius_m;
  ring.lines = s.lines;
  ring.eccentricity_m = s.eccentricity_m *
                        Eigen::Vector2d(std::cos(s.eccentricity_azimuth_rad), std::sin(s.eccentricity_azimuth_rad));
  ring.tilt_rad = s.tilt_rad * Eigen::Vector2d(std::cos(s.tilt_azimuth_rad), std::sin(s.tilt_azimuth_rad));
  ring.ellipticity_m = s.ellipticity_m;
  ring.ellipticity_azimuth_rad = s.ellipticity_azimuth_rad;
  for (const HarmonicSettings& h : s.graduation) ring.graduation.push_back({h.order, h.amplitude, h.phase_rad});
  return ring;
}

}  // namespace

HobEncoders::HobEncoders(const Scenario& actual, const mechanics::SignalState& hob_signals)
    : table_settings_(HobOf(actual).table_encoder),
      from_origin_(HobOf(actual).hob_procedure.encoder_zero == "table_origin"),
      hob_ring_(RingOf(HobOf(actual).hob_encoder), {0.0, HobOf(actual).hob_encoder.head_height_m, 0.0}),
      hob_state_(hob_signals),
      hob_lines_(HobOf(actual).hob_encoder.lines),
      hob_signals_(hob_signals, HobOf(actual).hob_encoder.lines, HobOf(actual).hob_encoder.interpolation) {}

mechanics::RingEncoder HobEncoders::TableRing(double head_rad) const {
  return {RingOf(table_settings_), {head_rad, table_settings_.head_height_m, 0.0}};
}

double HobEncoders::Hob_rad(double shown_rad) const {
  return hob_ring_.Shaft_rad(mechanics::PhaseShowing_rad(hob_state_, hob_lines_ * shown_rad) / hob_lines_);
}

}  // namespace twinbench::sim
