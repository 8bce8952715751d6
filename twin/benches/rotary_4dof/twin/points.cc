#include "twin/benches/rotary_4dof/twin/points.h"

#include "twin/benches/rotary_4dof/settings.h"

namespace twinbench::sim {
namespace {

using units::arcsec, units::mrad, units::nm, units::um, units::urad;

constexpr double kAngleStep_rad = 1.0 * arcsec, kLengthStep_m = 1.0 * um;

model::Point Angle(const char* name) {
  return {name, "arcsec", arcsec, kAngleStep_rad};
}
model::Point Length(const char* name) {
  return {name, "um", um, kLengthStep_m};
}
model::Point Share(const char* name) {
  return {name, "1", 1.0, 1e-4};
}

model::Point Growth(const char* name) {
  return {name, "um/K", um, 0.1 * um};
}

model::Point NotNegative(model::Point point) {
  point.lower = 0.0;
  return point;
}

std::vector<RotaryPoint> OfTables() {
  return {{Angle("target.ex"), [](RotaryExtra& e) -> double& { return e.pose.target_error.ex_rad; }},
          {Angle("target.ey"), [](RotaryExtra& e) -> double& { return e.pose.target_error.ey_rad; }},
          {Angle("target.ez"), [](RotaryExtra& e) -> double& { return e.pose.target_error.ez_rad; }},
          {Length("target.dx"), [](RotaryExtra& e) -> double& { return e.pose.target_error.dx_m; }},
          {Length("target.dy"), [](RotaryExtra& e) -> double& { return e.pose.target_error.dy_m; }},
          {Length("target.dz"), [](RotaryExtra& e) -> double& { return e.pose.target_error.dz_m; }},
          {Angle("reference.ex"), [](RotaryExtra& e) -> double& { return e.pose.reference_error.ex_rad; }},
          {Angle("reference.ey"), [](RotaryExtra& e) -> double& { return e.pose.reference_error.ey_rad; }},
          {Angle("reference.ez"), [](RotaryExtra& e) -> double& { return e.pose.reference_error.ez_rad; }},
          {Length("reference.dx"), [](RotaryExtra& e) -> double& { return e.pose.reference_error.dx_m; }},
          {Length("reference.dy"), [](RotaryExtra& e) -> double& { return e.pose.reference_error.dy_m; }},
          {Length("reference.dz"), [](RotaryExtra& e) -> double& { return e.pose.reference_error.dz_m; }},
          {Angle("seat.ex"), [](RotaryExtra& e) -> double& { return e.seat.ex_rad; }},
          {Angle("seat.ey"), [](RotaryExtra& e) -> double& { return e.seat.ey_rad; }},
          {Length("seat.dx"), [](RotaryExtra& e) -> double& { return e.seat.dx_m; }},
          {Length("seat.dy"), [](RotaryExtra& e) -> double& { return e.seat.dy_m; }},
          {Angle("target.yaw"), [](RotaryExtra& e) -> double& { return e.pose.target_yaw_rad; }},
          {Angle("reference.yaw"), [](RotaryExtra& e) -> double& { return e.pose.reference_yaw_rad; }}};
}

std::vector<RotaryPoint> OfGrating() {
  return {{Angle("grating.yaw"), [](RotaryExtra& e) -> double& { return e.pose.grating_yaw_rad; }},
          {Angle("grating.tilt"), [](RotaryExtra& e) -> double& { return e.pose.grating_tilt_rad; }},
          {Angle("grating.roll"), [](RotaryExtra& e) -> double& { return e.pose.grating_roll_rad; }},
          {Length("grating.lateral"), [](RotaryExtra& e) -> double& { return e.pose.grating_shift_m; }},
          {Angle("mount.ez"), [](RotaryExtra& e) -> double& { return e.mount.ez_rad; }},
          {Angle("mount.ex"), [](RotaryExtra& e) -> double& { return e.mount.ex_rad; }},
          {Angle("mount.ey"), [](RotaryExtra& e) -> double& { return e.mount.ey_rad; }},
          {Length("mount.dy"), [](RotaryExtra& e) -> double& { return e.mount.dy_m; }}};
}

std::vector<RotaryPoint> OfLightAndChannels() {
  return {
      {{"laser.yaw", "urad", urad, 1.0 * urad}, [](RotaryExtra& e) -> double& { return e.light.yaw_rad; }},
      {{"laser.pitch", "urad", urad, 1.0 * urad}, [](RotaryExtra& e) -> double& { return e.light.pitch_rad; }},
      {{"laser.wavelength", "nm", nm, 0.01 * nm}, [](RotaryExtra& e) -> double& { return e.light.wavelength_m; }},
      {Length("psd_a_x"), [](RotaryExtra& e) -> double& { return e.shown_m[0]; }},
      {Length("psd_a_y"), [](RotaryExtra& e) -> double& { return e.shown_m[1]; }},
      {Length("psd_b_x"), [](RotaryExtra& e) -> double& { return e.shown_m[2]; }},
      {Length("psd_b_y"), [](RotaryExtra& e) -> double& { return e.shown_m[3]; }}};
}

std::vector<RotaryPoint> OfBench() {
  return {{Share("amplifier.psd_a_x.gain"), nullptr,
           [](Scenario& s) -> double& { return RotaryOf(s).amplifier.gain_error[0]; }},
          {Share("amplifier.psd_a_y.gain"), nullptr,
           [](Scenario& s) -> double& { return RotaryOf(s).amplifier.gain_error[1]; }},
          {Share("amplifier.psd_b_x.gain"), nullptr,
           [](Scenario& s) -> double& { return RotaryOf(s).amplifier.gain_error[2]; }},
          {Share("amplifier.psd_b_y.gain"), nullptr,
           [](Scenario& s) -> double& { return RotaryOf(s).amplifier.gain_error[3]; }},
          {{"psd_a.roll", "mrad", mrad, 1e-4},
           nullptr,
           [](Scenario& s) -> double& { return RotaryOf(s).psd_a.roll_rad; }},
          {{"psd_b.roll", "mrad", mrad, 1e-4},
           nullptr,
           [](Scenario& s) -> double& { return RotaryOf(s).psd_b.roll_rad; }},
          {Length("psd_a.distance"), nullptr, [](Scenario& s) -> double& { return RotaryOf(s).psd_a.distance_m; }},
          {Length("psd_b.distance"), nullptr, [](Scenario& s) -> double& { return RotaryOf(s).psd_b.distance_m; }},
          {{"psd_a.cubic", "1/m2", 1.0, 1.0},
           nullptr,
           [](Scenario& s) -> double& { return RotaryOf(s).psd_a.cubic_per_m2; }},
          {{"psd_b.cubic", "1/m2", 1.0, 1.0},
           nullptr,
           [](Scenario& s) -> double& { return RotaryOf(s).psd_b.cubic_per_m2; }},
          {NotNegative(Share("psd_a.stray")), nullptr,
           [](Scenario& s) -> double& { return RotaryOf(s).psd_a.stray_fraction; }},
          {NotNegative(Share("psd_b.stray")), nullptr,
           [](Scenario& s) -> double& { return RotaryOf(s).psd_b.stray_fraction; }},
          {Growth("psd_a.post_growth"), nullptr,
           [](Scenario& s) -> double& { return RotaryOf(s).psd_a.post_growth_m_K; }},
          {Growth("psd_b.post_growth"), nullptr,
           [](Scenario& s) -> double& { return RotaryOf(s).psd_b.post_growth_m_K; }},
          {Growth("laser.post_growth"), nullptr,
           [](Scenario& s) -> double& { return RotaryOf(s).laser.post_growth_m_K; }},
          {{"grating.expansion", "ppm/K", 1e-6, 1e-6},
           nullptr,
           [](Scenario& s) -> double& { return RotaryOf(s).grating.expansion_per_K; }},
          {{"grating.lines_per_m", "1/mm", 1e3, 10.0}, nullptr, [](Scenario& s) -> double& {
             return RotaryOf(s).grating.lines_per_m;
           }}};
}

std::vector<RotaryPoint> AllPoints() {
  std::vector<RotaryPoint> all = OfTables();
  for (const auto& part : {OfGrating(), OfLightAndChannels(), OfBench()})
    all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace

const std::vector<RotaryPoint>& RotaryPoints() {
  static const std::vector<RotaryPoint> points = AllPoints();
  return points;
}

}  // namespace twinbench::sim
