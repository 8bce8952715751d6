#include "twin/benches/freeform_five_axis/format.h"
#include "twin/core/effect_entries.h"

namespace twinbench::benches::freeform {
namespace {

const std::vector<std::string> kQuadrantChannels = {"qpd_x", "qpd_y"};
const std::vector<std::string> kSlides = {"x", "y", "z"};

EffectParameter Ratio(double value, double limit, const std::string& meaning) {
  return Signed("ratio", "1", value, limit, meaning);
}

// Defaults are sizes that are plausible before checking.
std::vector<EffectEntry> QuadrantEffects() {
  return {
      {"qpd_gain",
       "quadrant detector whose signal is too large",
       kQuadrantChannels,
       {Ratio(0.005, 0.9, "too much")}},
      {"leakage",
       "part of the light falls on a fixed place of the quadrant detector",
       kQuadrantChannels,
       {Parameter("fraction", "1", 0.005, -0.9, 0.9, "of the light"),
        Signed("at", "V", 0.5, 100.0, "what all light would show there")}},
      {"laser_drift",
       "spot that drifts over the run",
       kQuadrantChannels,
       {Signed("spot", "mm", 0.005, 10.0, "from the first reading to the last")}},
      {"qpd_roll",
       "quadrant detector rotated about the beam",
       {},
       {Signed("roll", "rad", 0.03, 3.0, "of the axes of its signals")}},
      {"spot_size",
       "spot larger than stated",
       {},
       {Ratio(0.005, 0.9, "too much").Multiplies("qpd.spot_radius_mm")}},
      {"focal_length", "lens of another focal length", {}, {Ratio(0.005, 0.9, "too much").Multiplies("qpd.lens_mm")}},
  };
}

std::vector<EffectEntry> HeightEffects() {
  return {
      {"ccd_scale",
       "triangulation that shows too much",
       {},
       {Ratio(0.0005, 0.9, "too much").Divides("ccd.pixel_um")}},
      {"ccd_nonlinearity",
       "triangulation that bends",
       {},
       {Signed("bend", "per_px", 3e-7, 1e-3, "times the square of the way from the centre")}},
      {"slope_crosstalk",
       "slope of the surface that moves the triangulation's spot",
       {},
       {Signed("per_spot", "px", 0.2, 100.0, "times what the quadrant detector shows in x, of its sum")}},
  };
}

std::vector<EffectEntry> ArtefactEffects() {
  return {
      {"vertex_radius",
       "paraboloids of another curvature",
       {},
       {Ratio(0.0003, 0.5, "too large").Multiplies("artefact.vertex_radius_mm")}},
      {"artefact_pitch", "array stretched along one side", {"x"}, {Ratio(5e-6, 0.1, "too large")}, "x"},
      {"artefact_form",
       "cells higher and lower in a wave over the array",
       {},
       {Signed("cosine", "um", 0.5, 1000.0, "amplitude of the wave's cosine, at the middle 0"),
        Signed("sine", "um", 0.0, 1000.0, "likewise of its sine"),
        Parameter("waves", "1", 1.5, 0.5, 6.0, "periods over the side of the array"),
        Signed("azimuth", "deg", 45.0, 90.0, "along which it runs, from the artefact's x")}},
  };
}

std::vector<EffectEntry> MachineEffects() {
  return {
      {"cyclic",
       "error of a slide that repeats with the pitch of its scale or screw",
       kSlides,
       {Signed("cosine", "um", 0.2, 1000.0, "of cos(2 pi coordinate / pitch)"),
        Signed("sine", "um", 0.0, 1000.0, "of the sine"), Parameter("pitch", "mm", 10.0, 2.0, 40.0, "period")}},
      {"backlash",
       "axis that stays behind its command by half the play, according to the sense of its last move",
       {"x", "y", "a", "b"},
       {Signed("half", "um", 0.3, 1000.0, "half width", {"x", "y"}),
        Signed("half_angle", "arcsec", 0.3, 3600.0, "half width", {"a", "b"})}},
      {"thermal_growth",
       "spindle that grows with the temperature",
       kSlides,
       {Signed("growth", "um_K", 1.0, 1000.0, "along this axis"),
        Parameter("lag", "s", 300.0, 1.0, 1e5, "time constant behind the temperature")}},
      {"slip",
       "artefact that slips on its table, until it is mounted anew",
       kSlides,
       {Signed("step", "um", 0.5, 1000.0, "along this axis of the X slide"),
        Parameter("at_reading", "1", 100.0, 0.0, 1e9, "first reading behind it")}},
      {"tone",
       "slide that swings at one frequency, or a signal that has one picked up",
       {"x", "y", "z", "qpd_x", "qpd_y"},
       {Signed("cosine", "um", 0.3, 1000.0, "of cos(2 pi frequency time)", kSlides),
        Signed("sine", "um", 0.0, 1000.0, "of the sine", kSlides),
        Signed("cosine_signal", "V", 0.02, 100.0, "of the cosine", kQuadrantChannels),
        Signed("sine_signal", "V", 0.0, 100.0, "of the sine", kQuadrantChannels),
        Parameter("frequency", "Hz", 0.03, 1e-5, 1000.0, "of the swing")}},
      {"outliers",
       "readings that are disturbed for no lasting reason",
       {},
       {Parameter("fraction", "1", 0.01, 0.0, 0.5, "share of the readings"),
        Parameter("size", "um", 2.0, 0.0, 1000.0, "typical size, of the tip along Y")}},
  };
}

}  // namespace

std::vector<EffectEntry> Effects() {
  return Joined({QuadrantEffects(), HeightEffects(), ArtefactEffects(), MachineEffects()});
}

}  // namespace twinbench::benches::freeform
