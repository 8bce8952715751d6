#include "twin/sim/hob/encoders.h"

#include <cmath>

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
    : table_settings_(actual.table_encoder),
      from_origin_(actual.hob_procedure.encoder_zero == "table_origin"),
      hob_ring_(RingOf(actual.hob_encoder), {0.0, actual.hob_encoder.head_height_m, 0.0}),
      hob_state_(hob_signals),
      hob_lines_(actual.hob_encoder.lines),
      hob_signals_(hob_signals, actual.hob_encoder.lines, actual.hob_encoder.interpolation) {}

mechanics::RingEncoder HobEncoders::TableRing(double head_rad) const {
  return {RingOf(table_settings_), {head_rad, table_settings_.head_height_m, 0.0}};
}

double HobEncoders::Hob_rad(double shown_rad) const {
  return hob_ring_.Shaft_rad(mechanics::PhaseShowing_rad(hob_state_, hob_lines_ * shown_rad) / hob_lines_);
}

}  // namespace twinbench::sim
