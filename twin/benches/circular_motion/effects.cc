#include "twin/benches/circular_motion/format.h"
#include "twin/core/effect_entries.h"

namespace twinbench::benches::circular {
namespace {

std::vector<std::string> Axes() {
  return {"x", "y"};
}

std::vector<EffectEntry> GeometryEffects() {
  return {{"scale",
           "positioning error in proportion to the way",
           Axes(),
           {Signed("error", "um_m", 5.0, 1e4, "of the axis").Adds("machine.scale_@_um_m")}},
          {"squareness",
           "axes not at a right angle",
           {},
           {Signed("angle", "arcsec", 2.0, 3600.0, "from +X to +Y less 90 deg").Adds("machine.squareness_arcsec")}},
          {"straightness",
           "bow of the guideway of the other axis",
           Axes(),
           {Signed("bow", "um", 1.0, 1000.0, "times P2(other axis / machine.span)").Adds("machine.straightness_@_um")}},
          {"cyclic",
           "error that repeats with the pitch of a screw or scale",
           Axes(),
           {Signed("cosine", "um", 0.0, 1000.0, "amplitude of the cosine of 2 pi coordinate / pitch"),
            Signed("sine", "um", 0.3, 1000.0, "amplitude of its sine"),
            Parameter("pitch", "mm", 10.0, 0.01, 1000.0, "of the screw or scale")}}};
}

std::vector<EffectEntry> MotionEffects() {
  return {{"backlash",
           "axis that stays behind on reversal",
           Axes(),
           {Signed("width", "um", 1.0, 1000.0, "full width").Adds("machine.backlash_@_um")}},
          {"reversal_spike",
           "axis that sticks at its reversal and comes loose",
           Axes(),
           {Signed("height", "um", 2.0, 1000.0, "largest excursion"),
            Parameter("time", "s", 0.5, 0.01, 100.0, "from the reversal to the largest excursion")}},
          {"servo_lag", "both axes follow later than stated", {}, {Signed("lag", "s", 5e-4, 1.0, "of both").Adds("machine.lag_x_s").Adds("machine.lag_y_s")}},
          {"servo_mismatch",
           "one axis follows later than the other",
           {},
           {Signed("lag", "s", 1e-4, 1.0, "of x less that of y; half of it each")
                .Adds("machine.lag_x_s", 0.5)
                .Adds("machine.lag_y_s", -0.5)}}};
}

std::vector<EffectEntry> ThermalEffects() {
  return {{"thermal_growth",
           "scale of an axis that grows with the temperature",
           Axes(),
           {Signed("growth", "um_m_K", 5.0, 1000.0, "from 20 °C on").Adds("machine.expansion_@_um_m_K")}},
          {"drift",
           "spindle that moves against the table with the temperature",
           Axes(),
           {Signed("drift", "um_K", 1.0, 1000.0, "from 20 °C on"),
            Parameter("lag", "s", 0.0, 0.0, 1e5, "behind the temperature")}},
          {"bar_expansion",
           "bar that grows with the temperature",
           {},
           {Signed("growth", "um_m_K", 5.0, 1000.0, "from 20 °C on").Adds("bar.expansion_um_m_K")}}};
}

std::vector<EffectEntry> InstrumentEffects() {
  return {
      {"encoder_latency",
       "encoder read earlier or later than the bar",
       {},
       {Signed("latency", "s", 5e-4, 1.0, "the reading is this old").Adds("encoder.latency_s")}},
      {"bar_gain",
       "transducer that shows too much in proportion",
       {},
       {Signed("gain", "1", 0.005, 0.5, "share").Adds("bar.gain_error")}},
      {"bar_nonlinearity",
       "transducer that shows too much by the cube",
       {},
       {Signed("cubic", "per_mm2", 1.0, 1000.0, "of the reading").Adds("bar.cubic_per_mm2")}},
      {"ball_form",
       "ball out of round",
       {},
       {Signed("cosine", "um", 0.1, 100.0, "of order * azimuth"), Signed("sine", "um", 0.0, 100.0, "likewise"),
        Parameter("order", "1", 3.0, 2.0, 3.0, "periods per turn")}},
      {"eccentricity",
       "scale of the encoder off its axis",
       {},
       {Signed("cosine", "arcsec", 1.0, 3600.0, "of the angle"),
        Signed("sine", "arcsec", 0.0, 3600.0, "likewise")}},
      {"ellipticity",
       "scale of the encoder out of round",
       {},
       {Signed("cosine", "arcsec", 1.0, 3600.0, "of twice the angle"),
        Signed("sine", "arcsec", 0.0, 3600.0, "likewise")}},
      {"tilt",
       "axis of the encoder tilted, the bar out of its plane",
       {},
       {Signed("tilt_x", "mrad", 0.5, 100.0, "about X").Adds("encoder.tilt_x_mrad"),
        Signed("tilt_y", "mrad", 0.0, 100.0, "about Y").Adds("encoder.tilt_y_mrad"),
        Parameter("height", "mm", 3.0, 0.1, 100.0, "ball 2 above ball 1, where the scenario says 0")}},
      {"grid_scale",
       "grid that shows too much in proportion",
       Axes(),
       {Signed("error", "um_m", 2.0, 1e4, "of the axis").Adds("grid.scale_@_um_m")}},
      {"grid_shear",
       "axes of the grid not at a right angle",
       {},
       {Signed("angle", "arcsec", 1.0, 3600.0, "of the y axis").Adds("grid.shear_arcsec")}}};
}

std::vector<EffectEntry> ReadingEffects() {
  return {{"slip",
           "sudden step of the spindle against the table",
           Axes(),
           {Signed("step", "um", 2.0, 1e5, "size"),
            Parameter("at_reading", "1", 100.0, 0.0, 1e9, "first reading behind the step")}},
          {"tone",
           "vibration of the radius in time",
           {},
           {Parameter("amplitude", "um", 0.5, 0.0, 1000.0, "of the wave"),
            Parameter("frequency", "Hz", 0.01, 1e-5, 1e4, "of the wave"),
            Signed("phase", "deg", 0.0, 720.0, "of its cosine at the start")}},
          {"outliers",
           "readings that are disturbed for no lasting reason",
           {},
           {Parameter("fraction", "1", 0.01, 0.0, 0.5, "share of the readings"),
            Parameter("size", "um", 5.0, 0.0, 1e5, "typical size")}}};
}

}  // namespace

std::vector<EffectEntry> Effects() {
  return Joined({GeometryEffects(), MotionEffects(), ThermalEffects(), InstrumentEffects(), ReadingEffects()});
}

}  // namespace twinbench::benches::circular
