#include "twin/benches/rotary_4dof/format.h"
#include "twin/core/effect_entries.h"
#include "twin/core/reading.h"

namespace twinbench::benches::rotary {
namespace {

std::vector<std::string> ChannelPlaces() {
  return {kChannelNames.begin(), kChannelNames.end()};
}

std::vector<std::string> TonePlaces() {
  std::vector<std::string> places = ChannelPlaces();
  places.insert(places.end(), {"yaw", "tilt", "all"});
  return places;
}

// Defaults are sizes that are plausible before checking; the ranges stand beside the entries.
std::vector<EffectEntry> DetectorEffects() {
  const std::vector<std::string> psds = {"psd_a", "psd_b"};
  return {
      // 0.1-2 %
      {"psd_gain",
       "gain of one PSD axis and its amplifier",
       ChannelPlaces(),
       {Signed("gain_error", "1", 0.005, 0.5, "relative error of the gain").Adds("amplifier.gain_error[@]")}},
      // 0.1-1 deg
      {"psd_roll",
       "PSD rotated about the diffracted beam",
       psds,
       {Signed("roll", "mrad", 5.0, 500.0, "angle, right-handed towards the light").Adds("@.roll_mrad")}},
      // 0.1-3 % of the range at the edge; 180000 /m^2 is 0.45 % at 5 mm
      {"psd_nonlinearity",
       "pincushion of a PSD",
       psds,
       {Signed("cubic", "per_m2", 180000.0, 1e7, "u -> u (1 + cubic r^2)").Adds("@.cubic_per_m2")}},
      // 0.01-1 %
      {"stray_light",
       "uniform stray light that pulls the spot to the centre",
       psds,
       {Parameter("fraction", "1", 0.01, 0.0, 0.9, "stray light / signal").Adds("@.stray_fraction")}},
      // 1-20 uA: a lamp on a detector without a filter; 5 uA are 0.7 % of the signal of 5 mW of laser
      {"background",
       "ambient light on a PSD that counts as signal and pulls the spot to the centre",
       psds,
       {Parameter("current", "nA", 5000.0, 0.0, 1e5, "that it makes").Adds("@.background_nA")}},
      // 0.1-1 %; 1 mm of 120 mm is 0.8 %.
      {"psd_distance",
       "distance from the grating to one PSD, or to both",
       {"psd_a", "psd_b", "both"},
       {Signed("distance_error", "mm", 1.0, 50.0, "actual - nominal")
            .Adds("psd_a.distance_mm", 1.0, {"psd_a", "both"})
            .Adds("psd_b.distance_mm", 1.0, {"psd_b", "both"})}},
  };
}

std::vector<EffectEntry> LightEffects() {
  return {
      // 0-15 nm
      {"wavelength_offset",
       "wavelength other than stated",
       {},
       {Signed("wavelength_error", "nm", 2.0, 100.0, "actual - nominal").Adds("laser.wavelength_nm")}},
      // grooves are ruled to parts in a hundred thousand; a label may name another grating
      {"grating_pitch",
       "grooves at another distance than stated",
       {},
       {Signed("pitch_error", "1", 0.003, 0.2, "actual / nominal - 1").Divides("grating.lines_per_mm")}},
      // 30-600 nm: a twentieth of a wave to a wave; more where a cell strains it
      {"grating_form",
       "grating whose front is no plane",
       {"sphere", "astigmatism"},
       {Signed("height", "nm", 300.0, 1e6, "of the front at half its width above its middle").Adds("grating.@_nm")}},
      // 0.2-0.5 nm
      {"mode_hop",
       "sudden step of the wavelength",
       {},
       {Signed("wavelength_step", "nm", 0.25, 10.0, "behind the hop"),
        Parameter("at_reading", "1", 200.0, 0.0, 1e9, "first reading behind the hop")}},
      // 0.2-0.3 nm/K
      {"wavelength_temperature",
       "wavelength that follows the temperature",
       {},
       {Signed("wavelength_per_kelvin", "nm_per_K", 0.25, 10.0, "against environment.reference_degC")
            .Adds("laser.wavelength_per_kelvin_nm")}},
      // 0.1-1 deg
      {"incidence_offset",
       "laser that does not meet the grating at right angles",
       {},
       {Signed("incidence", "mrad", 5.0, 500.0, "angle in the plane of dispersion, positive from +x")}},
      // 1-50 urad/h
      {"laser_drift",
       "pointing of the laser that drifts with time",
       {"yaw", "pitch"},
       {Signed("drift", "urad_per_h", 20.0, 10000.0, "mean rate over the first hour"),
        Signed("curvature", "1", 0.0, 1.0, "share of a quadratic part, zero at 0 and 1 h")}},
  };
}

std::vector<EffectEntry> BodyEffects() {
  const std::vector<std::string> axes = {"yaw", "tilt"};
  return {
      // 1-4 um/K: 100 to 200 mm of steel or aluminium
      {"post_growth",
       "post of a PSD that grows with the temperature",
       {"psd_a", "psd_b"},
       {Signed("growth_per_kelvin", "um_K", 2.0, 1000.0, "of its height, against environment.reference_degC")
            .Adds("@.post_growth_um_K")}},
      // 0.2-5"
      {"mount_creep",
       "creep of the grating after every mounting",
       axes,
       {Signed("amplitude", "arcsec", 3.0, 1000.0, "amplitude * log(1 + t / time_constant)"),
        Parameter("time_constant", "s", 600.0, 1e-3, 1e6, "of the logarithm; t restarts at every mounting")}},
      // 0.5-5"/K, 10-60 min
      {"thermal_tilt",
       "grating that turns with the temperature",
       axes,
       {Signed("tilt_per_kelvin", "arcsec_per_K", 5.0, 1000.0, "against environment.reference_degC"),
        Parameter("lag", "s", 900.0, 0.0, 1e6, "time constant of a first-order lag")}},
      // 0.02-0.5"
      {"encoder_subdivision",
       "servo's encoder that errs within the periods of its graduation",
       {"target", "reference"},
       {Signed("amplitude", "arcsec", 0.1, 3.0, "of a sine of mechanics.encoder_periods per turn")}},
      // 0.1-20"
      {"backlash",
       "rotor that stays behind its encoder on reversal",
       {"target", "reference"},
       {Parameter("half_width", "arcsec", 1.0, 0.0, 3600.0, "half of the lost motion")},
       "target"},
      // 0.05-1"; larger because it decays within a dwell
      {"settling",
       "table still on its way when the block starts",
       {},
       {Signed("amplitude", "arcsec", 5.0, 3600.0, "still to go when the move has ended"),
        Parameter("time_constant", "s", 1.0, 1e-3, 1e4, "of the exponential approach")}},
      {"reclamp_frame", "grating remounted on the rotor where the scenario has the whole table re-mounted (reseat)", {}, {}},
      // 0.4-0.5 per turn, 0.05-1"
      {"bearing_half_frequency",
       "bearing motion once in about two turns",
       {},
       {Parameter("order", "1", 0.498, 0.3, 0.7, "periods per turn of the unwrapped angle"),
        Signed("tilt", "arcsec", 1.5, 300.0, "amplitude")}},
  };
}

std::vector<EffectEntry> TimeEffects() {
  return {
      // 0.05-2.5 um
      {"tone",
       "periodic disturbance in time",
       TonePlaces(),
       {Parameter("frequency", "Hz", 0.0169, 1e-6, 1e6, "of the disturbance, before it is aliased"),
        Signed("amplitude", "um", 0.5, 1000.0, "on a PSD"), Signed("phase", "deg", 0.0, 360.0, "at time 0")},
       "all"},
      // 0.2-50"
      {"slip",
       "sudden step of the grating's pose",
       {"yaw", "tilt", "lateral"},
       {Signed("angle", "arcsec", 3.0, 3600.0, "size of the step", {"yaw", "tilt"}),
        Signed("shift", "um", 5.0, 1000.0, "size of the step", {"lateral"}),
        Parameter("at_reading", "1", 200.0, 0.0, 1e9, "first reading behind the step")}},
  };
}

std::vector<EffectEntry> ElectronicEffects() {
  const std::vector<std::string> swaps = {"swap_xy_a",         "swap_xy_b",      "swap_psds",      "negate_psd_a_x",
                                          "negate_psd_a_y",    "negate_psd_b_x", "negate_psd_b_y", "reverse_target",
                                          "reverse_reference", "index_offset"};
  return {
      // 0.5-2 LSB = 0.1-0.3 um; 5 mV are 2.5 um, a damaged code
      {"adc_step",
       "step in the characteristic of the A/D converter",
       ChannelPlaces(),
       {Signed("step", "mV", 5.0, 1000.0, "added above the voltage"),
        Signed("at_voltage", "V", 0.0, 10.0, "where the step lies")}},
      // 0.01-0.5 %
      {"crosstalk",
       "channel that keeps some of the one scanned before it",
       ChannelPlaces(),
       {Signed("fraction", "1", 0.01, 0.5, "of the previous channel of the scan")}},
      {"outliers",
       "readings that are disturbed for no lasting reason",
       {},
       {Parameter("fraction", "1", 0.01, 0.0, 0.5, "share of the readings"),
        Parameter("size", "um", 10.0, 0.0, 5000.0, "typical size on one PSD axis")}},
      {"convention", "swap, sign or index blunder", swaps, {}},
  };
}

}  // namespace

std::vector<EffectEntry> Effects() {
  return Joined({DetectorEffects(), LightEffects(), BodyEffects(), TimeEffects(), ElectronicEffects()});
}

}  // namespace twinbench::benches::rotary
