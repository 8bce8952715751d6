#include "twin/benches/hob_transmission/format.h"
#include "twin/core/effect_entries.h"

namespace twinbench::benches::hob {
namespace {

const std::vector<std::string>& Encoders() {
  static const std::vector<std::string> encoders = {"table", "hob"};
  return encoders;
}

/// At the encoder that has it; what is seen of the hob's is smaller by the gearbox's ratio.
EffectParameter WaveAmplitude(double amplitude_arcsec) {
  return Signed("amplitude", "arcsec", amplitude_arcsec, 36000.0, "of amplitude * cos(order * angle + phase)");
}
EffectParameter WavePhase() {
  return Signed("phase", "deg", 0.0, 360.0, "of the same");
}

// Defaults are sizes that are plausible before checking; the ranges stand beside the entries.
std::vector<EffectEntry> RingEffects() {
  return {
      // a / R: 1 um on 50 mm is 4 arcsec; the paper's table encoder has 5.8
      {"eccentricity",
       "ring off the shaft's axis: once per turn of the ring",
       Encoders(),
       {WaveAmplitude(5.0), WavePhase()}},
      // 0.2-5 arcsec
      {"ellipticity", "ring out of round or tilted: twice per turn", Encoders(), {WaveAmplitude(1.0), WavePhase()}},
      {"periodic",
       "error of the ring's lines that repeats a whole number of times per turn: screws, copying of the scale",
       Encoders(),
       {Parameter("order", "1", 6.0, 1.0, 100000.0, "periods per turn of the ring"), WaveAmplitude(1.0),
        WavePhase()}},
  };
}

// Of the sine and cosine signals: 0.05-1 % of a line. The table's encoder is read at its own lines, where they are
// the same every time: they show on the hob's.
std::vector<EffectEntry> HobSignalEffects() {
  return {
      {"signal_offset",
       "sine and cosine signals of the hob's encoder not centred on zero",
       {},
       {Signed("offset_sin", "1", 0.02, 0.7, "of the sine, share of its amplitude"),
        Signed("offset_cos", "1", 0.0, 0.7, "of the cosine")}},
      {"amplitude_mismatch",
       "sine and cosine signals of the hob's encoder of unequal size",
       {},
       {Signed("ratio", "1", 0.04, 0.9, "amplitude of the sine over that of the cosine, - 1")}},
      {"quadrature_error",
       "sine and cosine signals of the hob's encoder not a quarter period apart",
       {},
       {Signed("angle", "mrad", 40.0, 1000.0, "lead of the sine")}},
  };
}

std::vector<EffectEntry> ChainEffects() {
  return {
      {"hob_runout", "hob spindle's drive: once per turn of the hob", {}, {WaveAmplitude(2.0), WavePhase()}},
      {"worm", "worm of the table: once per turn of the worm", {}, {WaveAmplitude(2.0), WavePhase()}},
      {"gear_mesh",
       "error that repeats with the teeth of the gear to be cut: twice per turn of a hob with two starts",
       {},
       {WaveAmplitude(1.0), WavePhase()}},
      {"backlash",
       "table that stays behind on reversal until a gap is crossed",
       {},
       {Parameter("width", "arcsec", 5.0, 0.0, 36000.0, "of the gap").Adds("transmission.backlash_arcsec")}},
      {"hysteresis",
       "torsion that goes over to the other sense gradually after a reversal: wind-up",
       {},
       {Signed("lag", "arcsec", 5.0, 36000.0, "behind, once settled, in either sense"),
        Parameter("settles_over", "deg", 20.0, 0.01, 36000.0, "travel of the table in which 63 % is reached")}},
      // 1 ms at 5 deg/s is 18 arcsec
      {"latency",
       "table's counter read later or earlier than the hob's",
       {},
       {Signed("delay", "s", 1e-4, 1.0, "the table's angle is this old; its error is -speed * delay")}},
  };
}

std::vector<EffectEntry> HobTimeEffects() {
  return {
      {"drift",
       "table that drifts against the hob with time: thermal growth",
       {},
       {Signed("rate", "arcsec_per_h", 20.0, 360000.0, "mean rate over the first hour"),
        Signed("curvature", "1", 0.0, 5.0, "share of a quadratic part, zero at 0 and 1 h")}},
      // a whole number of lines lost by a counter, or a coupling that gave way
      {"slip",
       "sudden step of an encoder's count",
       Encoders(),
       {Signed("step", "arcsec", 72.0, 360000.0, "size at that encoder"),
        Parameter("at_reading", "1", 1000.0, 0.0, 1e9, "first reading behind the step")}},
      {"tone",
       "vibration that the sampling folds to a slow wave in time",
       {},
       {Signed("amplitude", "arcsec", 1.0, 3600.0, "of amplitude * cos(2 pi frequency time + phase)"),
        Parameter("frequency", "Hz", 0.3, 1e-6, 1e6, "of the same"), WavePhase()}},
      {"outliers",
       "readings that are outliers for no lasting reason",
       {},
       {Parameter("fraction", "1", 0.003, 0.0, 0.5, "share of the readings"),
        Parameter("size", "arcsec", 10.0, 0.0, 36000.0, "typical size")}},
  };
}

}  // namespace

std::vector<EffectEntry> Effects() {
  return Joined({RingEffects(), HobSignalEffects(), ChainEffects(), HobTimeEffects()});
}

}  // namespace twinbench::benches::hob
