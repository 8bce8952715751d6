#include "twin/benches/rotary_4dof/bench.h"
#include "twin/diagnose/splits.h"

namespace twinbench::benches::rotary {

std::string NextMeasurement(const std::string& effect, const std::string& rival) {
  static const std::vector<diagnose::Split> splits = {
      {{"psd_distance", "stray_light"},
       "a reading with the laser off: stray light shows as a signal, a distance does not"},
      {{"background", "stray_light"},
       "the sweeps at half the laser's power: a background counts twice as much, stray light of the laser as "
       "before"},
      {{"background", "psd_distance"},
       "a reading with the laser off: a background shows as a current, a distance does not"},
      {{"background", "psd_gain"}, "a tilt sweep as well as a yaw sweep: a background scales both axes"},
      {{"psd_distance", "psd_gain"}, "a tilt sweep as well as a yaw sweep: a distance scales both axes"},
      {{"psd_gain", "stray_light"}, "a tilt sweep as well as a yaw sweep: stray light scales both axes"},
      {{"incidence_offset", "wavelength_offset"}, "a tilt sweep and a lateral shift of the grating"},
      {{"backlash", "settling"}, "measuring positions with dwells from 0.5 to 20 s"},
      {{"laser_drift", "mount_creep"}, "an hour of idle readings without re-mounting"},
      {{"laser_drift", "thermal_tilt"}, "a warm-up run with the temperature changed by 1 K"},
      {{"mount_creep", "thermal_tilt"}, "a warm-up run with the temperature changed by 1 K"},
      {{"grating_pitch", "wavelength_offset"},
       "the wavelength by a wavemeter, or the grating's pitch on another bench: the grating equation knows their "
       "product"},
      {{"mode_hop", "slip"},
       "the PSDs at another distance, or order 0 beside them: a hop moves no order 0, a shift of the grating does"},
      {{"post_growth", "thermal_tilt"},
       "the warm-up with one detector's post kept at its temperature: the grating tilts both spots, a post lowers "
       "its own"},
      {{"laser_drift", "post_growth"}, "a warm-up run with the temperature changed by 1 K"},
      {{"mount_creep", "slip"}, "the same mounting once more, without re-mounting"},
      {{"backlash", "backlash"}, "a reversal of the target alone"}};
  return diagnose::WhatSplits(splits, effect, rival, "");
}

}  // namespace twinbench::benches::rotary
