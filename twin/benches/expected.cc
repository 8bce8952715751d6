#include "twin/benches/expected.h"

#include <algorithm>
#include <cmath>

#include "twin/benches/circular_motion/columns.h"
#include "twin/benches/circular_motion/settings.h"
#include "twin/benches/encoder_comparison/settings.h"
#include "twin/benches/freeform_five_axis/columns.h"
#include "twin/benches/freeform_five_axis/estimators/probe_model.h"
#include "twin/benches/hob_transmission/settings.h"
#include "twin/benches/names.h"
#include "twin/benches/plan_of.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/turntable_autocollimator/settings.h"
#include "twin/core/distributions.h"

namespace twinbench {
namespace {

using plausible::Expected;

constexpr double kStepOfAngles_rad = 1e-9;  // by which numbers of files are rounded

/// Where steps are larger than the noise, equal values say nothing of it.
double UnlessCoarse(double noise, double step) {
  return noise > step ? noise : 0.0;
}

double StandsStill(const Reading&) {
  return 0.0;
}

/// x of a PSD by the yaw that the autocollimator shows.
Expected ShownBySpot(const RotarySettings& s, const PsdSettings& psd, const std::string& column) {
  const double sin_order = s.laser.wavelength_m * s.grating.lines_per_m;
  const double V_rad = -psd.sensitivity_V_m * psd.distance_m * (1.0 + 1.0 / std::sqrt(1.0 - sin_order * sin_order));
  return {.column = column,
          .nominal = [V_rad](const Reading& r) { return V_rad * r.autocollimator_yaw_rad; },
          .by_axes = [V_rad](const Reading& r) { return V_rad * (r.target_rad + r.reference_rad); },
          .is_loose = true};
}

/// Of a mean over a block: as its samples scatter where the readings say so, else as the amplifier's noise is stated.
double BlockNoise_V(const RotarySettings& s, const std::vector<Reading>& readings, std::size_t channel) {
  std::vector<double> noise_V;
  for (const Reading& r : readings)
    if (r.n_samples > 0 && std::isfinite(r.std_V[channel])) noise_V.push_back(r.std_V[channel] / std::sqrt(r.n_samples));
  return noise_V.empty() ? s.amplifier.noise_V / std::sqrt(s.adc.samples) : Median(std::move(noise_V));
}

std::vector<Expected> ShownByTables(const RotarySettings& s, const std::vector<Reading>& readings) {
  std::vector<Expected> all = {ShownBySpot(s, s.psd_a, "psd_a_x_V"),
                               {.column = "psd_a_y_V", .by_axes = StandsStill},
                               ShownBySpot(s, s.psd_b, "psd_b_x_V"),
                               {.column = "psd_b_y_V", .by_axes = StandsStill}};
  const double step_V = 2.0 * s.adc.range_V * std::pow(0.5, s.adc.bits);
  for (std::size_t k = 0; k < all.size(); ++k)
    all[k].noise = UnlessCoarse(BlockNoise_V(s, readings, k), step_V), all[k].step = step_V;
  return all;
}

std::vector<Expected> ShownByDevice(const EncoderSettings& s) {
  const DeviceSettings device = DeviceOfMeans(s);
  return {{.column = "measured_deg",
           .noise = device.noise_known ? UnlessCoarse(device.noise_rad, device.resolution_rad) : 0.0,
           .step = device.resolution_rad,
           .nominal = [](const Reading& r) { return r.reference_rad; },
           .by_axes = [](const Reading& r) { return r.reference_rad; },
           .is_angle = true}};
}

/// To which the turntable brings x of a face; 0: all readings are at nominal angles, as of a table of faces.
double Nulled_rad(const TurntableSettings& s, const std::vector<Reading>& readings) {
  const TurntableProcedureSettings& p = s.turntable_procedure;
  const auto is_beside = [&](const Reading& r) {
    const double nominal_rad = (r.setup < p.SetUps() ? p.Of(p.polygon_offsets_rad, r.setup) : 0.0) - r.reference_rad;
    return std::abs(std::remainder(r.target_rad - nominal_rad, units::turn)) > kStepOfAngles_rad;
  };
  return s.HasPolygon() && std::ranges::any_of(readings, is_beside) ? std::hypot(s.collimator.deadband_rad, s.ReadingNoise_rad()) : 0.0;
}

std::vector<Expected> ShownByCollimator(const TurntableSettings& s, const std::vector<Reading>& readings) {
  const double noise = UnlessCoarse(s.ReadingNoise_rad(), s.HasPolygon() ? s.collimator.deadband_rad : 0.0);
  // The tilted axis is carried round by the turntable, and its teeth turn the mirror back.
  const auto tilt = [p = s.turntable_procedure](const Reading& r) {
    const bool is_planned = r.setup >= 0 && r.setup < p.SetUps() && r.phase == Phase::kFullCircle;
    return is_planned ? -p.Of(p.tilts_rad, r.setup) * std::sin(r.target_rad + p.Of(p.tilt_azimuths_rad, r.setup)) : kNaN;
  };
  return {{.column = "autocollimator_x_arcsec",
           .noise = noise,
           .nulled = Nulled_rad(s, readings),
           .nulled_noise = s.ReadingNoise_rad(),
           .by_axes = [](const Reading& r) { return r.target_rad; }},
          {.column = "autocollimator_y_arcsec", .noise = s.ReadingNoise_rad(), .course = tilt, .not_in = "autocollimator_x_arcsec",
           .by_axes = StandsStill}};
}

std::vector<Expected> ShownByHob(const HobSettings& s) {
  return {{.column = "hob_encoder_deg",
           .step = units::turn / s.hob_encoder.lines / s.hob_encoder.interpolation,
           .nominal = [times = s.transmission.HobOrder()](const Reading& r) { return times * r.measured_rad; },
           .is_angle = true}};
}

std::vector<Expected> ShownOfCircles(const CircularSettings& s) {
  using benches::circular::kCommandedX_m, benches::circular::kCommandedY_m;
  const auto angle = [](const Reading& r) { return std::atan2(kCommandedY_m(r), kCommandedX_m(r)); };
  return {{.column = "bar_um", .noise = UnlessCoarse(s.bar.noise_m, s.bar.resolution_m)},
          {.column = "encoder_deg",
           .step = units::turn / s.encoder.lines / s.encoder.interpolation,
           .nominal = angle,
           .is_angle = true},
          {.column = "grid_x_mm", .noise = s.grid.noise_m, .nominal = [](const Reading& r) { return kCommandedX_m(r); }},
          {.column = "grid_y_mm", .noise = s.grid.noise_m, .nominal = [](const Reading& r) { return kCommandedY_m(r); }}};
}

/// One number of the probe on an ideal machine.
std::function<double(const Reading&)> OfIdealMachine(const FreeformSettings& s, int channel) {
  return [s, channel](const Reading& r) {
    const auto poses = benches::freeform::estimators::PosesOf({r}, s);
    return poses.empty()
               ? kNaN
               : benches::freeform::estimators::Predicted(s, poses[0], benches::freeform::estimators::Inputs::Zero())[channel];
  };
}

/// How far mounting and machine may move the spot, against its size: of one moved further the voltages say only on which side it
/// is.
double SpotMoves(const FreeformSettings& s) {
  const double radius_m = 0.5 * (s.artefact.vertex_radius_m[0] + s.artefact.vertex_radius_m[1]);
  const double by_places = (s.artefact.mounting_m + s.machine.random_translation_m) / radius_m;
  constexpr double kAxes = 3.0;  // root of their number, of nine angles that turn the probe about its pivot
  const double by_axes = kAxes * s.machine.random_rotation_rad * (1.0 + s.machine.pivot_m / radius_m);
  const double by_angles = s.artefact.mounting_rad + s.machine.random_squareness_rad + by_axes;
  return 2.0 * s.qpd.lens_m * (by_places + by_angles) / s.qpd.spot_radius_m;
}

std::vector<Expected> ShownByProbe(const FreeformSettings& s) {
  constexpr double kMost = 0.3;
  const bool is_known = SpotMoves(s) < kMost;
  const auto x_V = OfIdealMachine(s, 0), y_V = OfIdealMachine(s, 1);
  return {{.column = "qpd_x_V", .noise = s.qpd.noise_V, .nominal = is_known ? x_V : nullptr, .by_axes = x_V, .is_loose = true},
          {.column = "qpd_y_V", .noise = s.qpd.noise_V, .nominal = is_known ? y_V : nullptr, .by_axes = y_V, .is_loose = true},
          {.column = "ccd_px", .noise = s.ccd.noise_px, .nominal = OfIdealMachine(s, 2)}};
}

}  // namespace

std::vector<Expected> ExpectedOf(const Scenario& scenario, const std::vector<Reading>& readings) {
  if (scenario.bench == kRotaryBench) return ShownByTables(RotaryOf(scenario), readings);
  if (scenario.bench == kEncoderBench) return ShownByDevice(EncoderOf(scenario));
  if (scenario.bench == kTurntableBench) return ShownByCollimator(TurntableOf(scenario), readings);
  if (scenario.bench == kHobBench) return ShownByHob(HobOf(scenario));
  if (scenario.bench == kCircularBench) return ShownOfCircles(CircularOf(scenario));
  if (scenario.bench == kFreeformBench) return ShownByProbe(FreeformOf(scenario));
  return {};
}

std::vector<plausible::Finding> DoubtsAbout(const std::vector<Reading>& readings, const Scenario& scenario) {
  return plausible::Check(readings, scenario, ExpectedOf(scenario, readings), PlanOf(scenario, readings));
}

}  // namespace twinbench
