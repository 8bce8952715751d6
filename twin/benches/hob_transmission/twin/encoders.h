#pragma once

#include "mechanics/encoder_signal.h"
#include "mechanics/ring_encoder.h"
#include "twin/benches/hob_transmission/settings.h"
#include "twin/core/scenario.h"

namespace twinbench::sim {

/// Both ring encoders between the shafts and what they show: without noise, and before anything is counted.
class HobEncoders {
 public:
  HobEncoders(const Scenario& actual, const mechanics::SignalState& hob_signals);

  /// The table's ring, with the head where the mark passes it with the table at `head_rad`.
  mechanics::RingEncoder TableRing(double head_rad) const;
  /// What the table's encoder shows where its scale is at an angle.
  double TableShown_rad(double scale_rad, double head_rad) const {
    return scale_rad + (from_origin_ ? head_rad : 0.0);
  }

  const mechanics::RingEncoder& hob_ring() const { return hob_ring_; }
  const mechanics::InterpolatedSignal& hob_signals() const { return hob_signals_; }
  /// The hob's angle where its encoder shows this.
  double Hob_rad(double shown_rad) const;

 private:
  RingEncoderSettings table_settings_;
  bool from_origin_;
  mechanics::RingEncoder hob_ring_;
  mechanics::SignalState hob_state_;
  int hob_lines_;
  mechanics::InterpolatedSignal hob_signals_;
};

}  // namespace twinbench::sim
