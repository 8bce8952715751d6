#include "twin/benches/encoder_comparison/format.h"
#include "twin/core/effect_entries.h"

namespace twinbench::benches::encoder {
namespace {

/// What is added to the angle: amplitude * cos(order * angle + phase).
EffectParameter HarmonicAmplitude(double amplitude_deg) {
  return Signed("amplitude", "deg", amplitude_deg, 10.0, "of amplitude * cos(order * angle + phase)");
}
EffectParameter HarmonicPhase() {
  return Signed("phase", "deg", 0.0, 360.0, "of the same");
}

/// Faults of the signals show at other angles of a device whose signals begin elsewhere.
EffectParameter SignalZero() {
  return Signed("zero", "deg", 0.0, 360.0, "device angle where the sine rises, beyond device.signal_zero");
}

/// How a stop was reached matters to what remembers the way.
EffectParameter Approach() {
  return Parameter("approach", "1", 1.0, 0.0, 1.0,
                   "1: a measuring position is reached in its direction over half the way from its neighbour; 0: straight");
}

EffectParameter BehindTemperature() {
  return Parameter("lag", "s", 0.0, 0.0, 1e5, "behind the temperature");
}

// Defaults are sizes that are plausible before checking; the ranges stand beside the entries.
std::vector<EffectEntry> MountingAndShapeEffects() {
  return {
      // a / R: 1 um on 50 mm is 0.001 deg; 0.5 deg for the magnet of a small magnetic encoder
      {"eccentricity", "scale off the axis, once per turn", {}, {HarmonicAmplitude(0.01), HarmonicPhase()}},
      // 0.2-5 arcsec on a ring, 0.3 deg on a magnet
      {"ellipticity", "scale out of round or tilted, twice per turn", {}, {HarmonicAmplitude(0.01), HarmonicPhase()}},
  };
}

// Of the sine and cosine signals, whose period is 1 / device.signal_periods of a turn: 0.05-1 % of them.
std::vector<EffectEntry> SignalEffects() {
  return {
      {"signal_offset",
       "sine and cosine signals not centred on zero",
       {},
       {Signed("offset_sin", "1", 0.002, 0.7, "of the sine, share of its amplitude"),
        Signed("offset_cos", "1", 0.0, 0.7, "of the cosine")}},
      {"amplitude_mismatch",
       "sine and cosine signals of unequal size",
       {},
       {Signed("ratio", "1", 0.004, 0.9, "amplitude of the sine over that of the cosine, - 1"), SignalZero()}},
      {"quadrature_error",
       "sine and cosine signals not a quarter period apart",
       {},
       {Signed("angle", "mrad", 4.0, 1000.0, "lead of the sine"), SignalZero()}},
      // Below 0.707 both signals are flat at once, and the reading stands still there.
      {"signal_clipping",
       "sine and cosine signals cut off",
       {},
       {Parameter("level", "1", 0.95, 0.3, 1.0, "at this share of the amplitude"), SignalZero()}},
      {"interpolation",
       "error that repeats with the lines of the scale; needs device.lines_per_turn",
       {},
       {Parameter("order", "1", 1.0, 1.0, 64.0, "periods a line"), HarmonicAmplitude(0.005), HarmonicPhase()}},
  };
}

std::vector<EffectEntry> MotionEffects() {
  return {
      // 1 ms at 5 deg/s is 18 arcsec
      {"latency",
       "device read later or earlier than the reference",
       {},
       {Signed("delay", "s", 0.001, 10.0, "the reading is this old; its error is -speed * delay"),
        Parameter("time_constant", "s", 0.0, 0.0, 10.0, "of a lag of first order behind that, a filter's or a servo's")}},
      // a quartz is right to 1e-4, the timer of a computer or of a controller of its own to 1e-3
      {"clock_rate",
       "clock of the device that runs fast against the reference's",
       {},
       {Signed("ratio", "1", 1e-3, 0.1, "the reading is older by this share of the time since the start")}},
      // without feedforward 1 / (gain of the position loop x gain of the speed loop): 100 and 400 1/s
      {"acceleration_error",
       "following error proportional to the acceleration: acceleration feedforward missing or too large",
       {},
       {Signed("coefficient", "s2", 2.5e-5, 10.0, "its error is -acceleration * coefficient")}},
      {"friction",
       "following error in the sense of the motion, none at rest: Coulomb friction of the drive",
       {},
       {Signed("lag", "deg", 0.01, 30.0, "behind the reference in either sense")}},
      {"backlash",
       "device that stays behind on reversal until a gap is crossed",
       {},
       {Signed("width", "deg", 0.01, 30.0, "of the gap; negative: the reference stays behind"),
        Parameter("crossed_over", "deg", 0.0, 0.0, 360.0, "way in which it is crossed; 0: its width"),
        Parameter("start", "1", -1.0, -1.0, 1.0, "where in the gap it begins, -1: half of it behind"), Approach()}},
      {"hysteresis",
       "device that goes over to the other sense gradually after a reversal",
       {},
       {Signed("lag", "deg", 0.01, 30.0, "behind the reference once settled, in either sense"),
        Parameter("settles_over", "deg", 20.0, 1e-6, 36000.0, "travel in which 63 % is reached"),
        Parameter("start", "1", 0.0, -1.0, 1.0, "what it begins with, 1: settled in the upward sense"),
        Approach()}},
      {"settling",
       "device that comes to rest after the reference: what is left of a move dies out while it stands",
       {},
       {Signed("amplitude", "deg", 0.01, 30.0, "behind, in motion and at the first reading of a measuring position"),
        Parameter("time_constant", "s", 1.0, 1e-3, 1e4, "of the decay")}},
      // 1e-6 to 1e-3 for a device without closure
      {"scale",
       "device that counts too much or too little per turn",
       {},
       {Signed("ratio", "1", 1e-5, 1.0, "measured = reference * (1 + ratio)"),
        Signed("curvature", "1", 0.0, 1e5, "share of a quadratic part: by how much the ratio grows in a turn")}},
  };
}

std::vector<EffectEntry> TimeAndReadingEffects() {
  return {
      {"drift",
       "zero of the device that drifts with time",
       {},
       {Signed("rate", "deg_per_h", 0.02, 3600.0, "mean rate over the first hour; of a warm-up, the first one"),
        Signed("curvature", "1", 0.0, 5.0, "share of a quadratic part, zero at 0 and 1 h"),
        Parameter("warm_up", "s", 0.0, 0.0, 1e6, "time in which 63 % of a warm-up is over; 0: it goes on")}},
      // 1 um/K on 50 mm is 0.001 deg/K
      {"zero_temperature",
       "zero of the device that follows the temperature",
       {},
       {Signed("coefficient", "deg_per_K", 0.002, 10.0, "of the zero"), BehindTemperature()}},
      // steel 11.5, glass 8, aluminium 23 um/m/K; a potentiometer 100 and more
      {"scale_temperature",
       "device whose scale grows with the temperature: a screw, a linear scale, a potentiometer",
       {},
       {Signed("growth", "um_m_K", 10.0, 1000.0, "of what it shows, against the reference's"), BehindTemperature()}},
      // one line of the scale, or a coupling that gave way
      {"slip",
       "sudden step of the device's zero",
       {},
       {Signed("step", "deg", 0.02, 360.0, "size"),
        Parameter("at_reading", "1", 100.0, 0.0, 1e9, "first reading behind the step")}},
      {"outliers",
       "readings that are disturbed for no lasting reason",
       {},
       {Parameter("fraction", "1", 0.01, 0.0, 0.5, "share of the readings"),
        Parameter("size", "deg", 0.05, 0.0, 360.0, "typical size")}},
  };
}

std::vector<EffectEntry> PeriodicEffects() {
  return {
      {"periodic",
       "error that repeats a whole number of times per turn: screws, poles, a polygon",
       {},
       {Parameter("order", "1", 7.0, 1.0, 100000.0, "periods per turn"), HarmonicAmplitude(0.01), HarmonicPhase()}},
      {"gear_mesh",
       "error that repeats with the teeth of a gear",
       {},
       {Parameter("teeth", "1", 44.0, 1.0, 100000.0, "of the gear, per turn"), HarmonicAmplitude(0.01),
        HarmonicPhase()}},
      {"reference_fault",
       "periodic error of the reference, tied to its own angle",
       {},
       {Parameter("order", "1", 1.0, 1.0, 100000.0, "periods per turn"), HarmonicAmplitude(0.01), HarmonicPhase()}},
  };
}

}  // namespace

std::vector<EffectEntry> Effects() {
  return Joined({MountingAndShapeEffects(), SignalEffects(), MotionEffects(), PeriodicEffects(), TimeAndReadingEffects()});
}

}  // namespace twinbench::benches::encoder
