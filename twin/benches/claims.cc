#include "twin/benches/claims.h"

#include <algorithm>
#include <cmath>

#include "twin/benches/encoder_comparison/settings.h"
#include "twin/benches/freeform_five_axis/place_noise.h"
#include "twin/benches/names.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/turntable_autocollimator/settings.h"

namespace twinbench {
namespace {

/// Of the mean of one block on one axis of a PSD.
double SpotNoise_m(const RotarySettings& s, const PsdSettings& psd) {
  return s.amplifier.noise_V / std::sqrt(static_cast<double>(s.adc.samples)) / psd.sensitivity_V_m;
}

double YawNoise_rad(const RotarySettings& s) {
  const double sin_order = s.laser.wavelength_m * s.grating.lines_per_m;
  const double a_turn = 1.0 + 1.0 / std::sqrt(1.0 - sin_order * sin_order);
  const double a = a_turn * s.psd_a.distance_m / SpotNoise_m(s, s.psd_a);
  const double b = a_turn * s.psd_b.distance_m / SpotNoise_m(s, s.psd_b);
  return 1.0 / std::hypot(a, b);
}

std::vector<Claim> OfTwoTables(const RotarySettings& s) {
  const double set_ups = std::max(1.0, static_cast<double>(s.procedure.shifts.size()) - 1.0);
  const double readings = set_ups * static_cast<double>(s.procedure.passes.size());
  const double u_rad = YawNoise_rad(s) / std::sqrt(readings);
  const std::string less = "fewer passes (procedure.passes) or mountings (procedure.shifts): less is averaged";
  return {{"target", u_rad, less}, {"reference", u_rad, less}};
}

std::vector<Claim> OfAComparison(const EncoderSettings& s) {
  const EncoderProcedureSettings& p = s.encoder_procedure;
  if (p.kind != "stops") return {};
  const double readings = std::max(1.0, static_cast<double>(p.passes.size()) * p.turns);
  return {{"shaft", DeviceOfMeans(s).noise_rad / std::sqrt(readings),
           "device.noise_deg as repeated readings of a measuring position scatter, with device.noise_known = true: the results' "
           "u grows with it"}};
}

std::vector<Claim> OfATurntable(const TurntableSettings& s) {
  if (s.HasPolygon()) return {};  // its encoder is read, not relied on
  const TurntableProcedureSettings& p = s.turntable_procedure;
  const double readings = static_cast<double>(p.passes.size()) * p.SetUps();
  return {
      {"turntable", std::hypot(s.Tooth_rad(), s.ReadingNoise_rad() / std::sqrt(readings)),
       "multitooth.u_tooth_arcsec with what the turntable leaves added in squares: the results' u grows with it"}};
}

std::vector<Claim> OfFiveAxes(const Scenario& scenario) {
  std::vector<Claim> claims;
  const auto u = benches::freeform::PlaceNoise(scenario);
  for (std::size_t axis = 0; axis < u.size(); ++axis) claims.push_back({kAxisNames[axis], u[axis],
                      "qpd.noise_mV and ccd.noise_px as repeated readings of a pose scatter: the results' u grows with them"});
  return claims;
}

std::vector<Claim> StatedClaims(const Scenario& scenario) {
  if (scenario.bench == kRotaryBench) return OfTwoTables(RotaryOf(scenario));
  if (scenario.bench == kEncoderBench) return OfAComparison(EncoderOf(scenario));
  if (scenario.bench == kTurntableBench) return OfATurntable(TurntableOf(scenario));
  if (scenario.bench == kFreeformBench) return OfFiveAxes(scenario);
  return {};
}

}  // namespace

std::vector<Claim> ClaimsOf(const Scenario& scenario) {
  if (scenario.noise_free) return {};
  std::vector<Claim> claims = StatedClaims(scenario);
  std::erase_if(claims, [](const Claim& claim) { return !(claim.u > 0.0) || !std::isfinite(claim.u); });
  return claims;
}

}  // namespace twinbench
