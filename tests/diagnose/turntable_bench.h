#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <functional>

#include "twin/benches/names.h"
#include "twin/benches/turntable_autocollimator/settings.h"
#include "twin/core/reading.h"
#include "twin/core/stream.h"

/// A turntable, a multi-tooth table, a mirror and an autocollimator as plain formulas, independent of the program:
/// rotations of a vector instead of small angles, and effects a little richer than those that a diagnosis looks
/// for.
namespace twinbench::diagnose::test {

using units::arcsec, units::deg, units::kPi;

/// What is wrong, or nothing. Sizes in SI.
struct Wrong {
  double roll_rad = 0.0, gain_error = 0.0, at_edge_rad = 0.0, sag_m = 0.0;
  std::array<double, 2> drift_rad_s{}, kelvin_rad{}, creep_rad{}, slip_rad{}, tone_rad{}, ripple_rad{};
  double creep_s = 60.0, tone_s = 900.0, tone_phase_rad = 0.7, modulation = 0.0;
  double ripple_period_rad = 1.7 * arcsec, ripple_phase_rad = 2.0, lag_s = 0.0;
  int slip_at = 100;
  double backlash_rad = 0.0, settling_rad = 0.0, settling_s = 1.0, seating_rad = 0.0;
  double spoilt = 0.0, spoilt_rad = 3.0 * arcsec;
  std::function<Eigen::Vector2d(const Reading&)> other = {};  // anything else, rad of x and y
};

/// 72 positions, two tilts, passes + and -, five dwells: what a careful user does.
inline Scenario CarefulScenario() {
  Scenario s;
  s.bench = kTurntableBench;
  TurntableOf(s).autocollimator.noise_rad = 0.1 * arcsec;
  TurntableOf(s).multitooth_table.repeatability_sd[static_cast<std::size_t>(Component::kEz)] = 0.05 * arcsec;
  TurntableOf(s).turntable_procedure.phases = {"calibration", "full_circle", "verification"};
  TurntableOf(s).turntable_procedure.tilt_azimuths_rad = {0.0, 130.0 * deg};
  TurntableOf(s).turntable_procedure.dwell_s = {0.5, 1.0, 2.0, 4.0, 8.0};
  return s;
}

/// The published procedure: two tilts, one pass each.
inline Scenario PublishedScenario() {
  Scenario s = CarefulScenario();
  TurntableOf(s).turntable_procedure.phases = {"full_circle"};
  TurntableOf(s).turntable_procedure.passes = {1};
  TurntableOf(s).turntable_procedure.dwell_s = {1.0};
  return s;
}

class Bench {
 public:
  Bench(const Scenario& scenario, Wrong wrong, std::uint64_t seed)
      : s_(scenario), wrong_(std::move(wrong)), truth_(seed, "bench.truth"), noise_(seed, "bench.noise") {
    for (int k = 1; k <= 12; ++k)
      waves_.push_back({4.0 * arcsec * truth_.Normal() / k, 2.0 * kPi * truth_.Uniform()});
    for (double& tooth : teeth_rad_) tooth = 0.1 * arcsec * truth_.Normal();
    for (double& w : wobble_rad_) w = 1.0 * arcsec * truth_.Normal();
    mirror_rad_ = 10.0 * arcsec * truth_.Normal();
    for (double& c : constants_rad_) c = 5.0 * arcsec * truth_.Normal();
    for (double& k : room_) k = truth_.Normal();
  }

  std::vector<Reading> Run() {
    const TurntableProcedureSettings& p = TurntableOf(s_).turntable_procedure;
    for (int setup = 0; setup < p.SetUps(); ++setup) {
      now_s_ += setup > 0 ? p.remount_s : 20.0;
      mounted_s_ = now_s_;
      now_s_ += 1.0;  // to the first stop
      if (setup == 0 && Has("calibration")) Sweep();
      for (std::size_t pass = 0; pass < p.passes.size(); ++pass)
        Circle(setup, static_cast<int>(pass), p.passes[pass], p.positions, 0.0, Phase::kFullCircle);
    }
    if (Has("verification"))
      Circle(p.SetUps() - 1, static_cast<int>(p.passes.size()), 1, 120, 1.0 * deg, Phase::kVerification);
    return readings_;
  }

 private:
  static constexpr double kLift_s = 4.0,
                          kMove_s = 0.6;  // the turntable moves while the multi-tooth table is lifted

  bool Has(const char* phase) const {
    return std::ranges::count(TurntableOf(s_).turntable_procedure.phases, phase) > 0;
  }

  void Circle(int setup, int pass, int direction, int positions, double offset_rad, Phase phase) {
    const int shift = TurntableProcedureSettings::Of(TurntableOf(s_).turntable_procedure.shifts, setup);
    for (int step = 0; step < positions; ++step) {
      Reading r{.setup = setup, .pass = pass, .direction = direction,
                .position = direction > 0 ? step : positions - 1 - step, .phase = phase};
      r.target_rad = offset_rad + r.position * 2.0 * kPi / positions;
      r.reference_rad = shift * 2.0 * kPi / TurntableOf(s_).multitooth.teeth - r.target_rad;
      Take(r);
    }
  }

  void Sweep() {
    const int n = TurntableOf(s_).turntable_procedure.sweep_points;
    for (int k = 0; k < n; ++k) {
      Reading r{.position = k, .phase = Phase::kCalibration,
                .target_rad = TurntableOf(s_).turntable_procedure.sweep_rad * (2.0 * k / (n - 1.0) - 1.0),
                .reference_rad = 0.0};
      Take(r);
    }
  }

  double Turntable(double angle_rad) const {
    double sum = 0.0;
    for (std::size_t k = 0; k < waves_.size(); ++k)
      sum += waves_[k][0] * std::sin(static_cast<double>(k + 1) * angle_rad + waves_[k][1]);
    return sum;
  }

  double Room_K(double time_s) const {
    return 0.3 * room_[0] + 0.15 * std::sin(time_s / 1900.0 + room_[1]) +
           0.1 * std::sin(time_s / 700.0 + room_[2]) + 0.1 * time_s / 3600.0;
  }

  /// The mirror's normal; it faces +y where both angles are zero.
  Eigen::Vector3d Normal(const Reading& r, double extra_rad) const {
    using Eigen::AngleAxisd;
    using Eigen::Vector3d;
    const auto& p = TurntableOf(s_).turntable_procedure;
    const double tilt_rad = TurntableProcedureSettings::Of(p.tilts_rad, r.setup);
    const double azimuth_rad = TurntableProcedureSettings::Of(p.tilt_azimuths_rad, r.setup);
    const Vector3d across(-std::sin(azimuth_rad), std::cos(azimuth_rad),
                          0.0);  // turns the axis towards the azimuth
    const double tooth = r.reference_rad / (2.0 * kPi) * TurntableOf(s_).multitooth.teeth;
    const auto index = static_cast<std::size_t>(((std::lround(tooth) % 360) + 360) % 360);
    const double wobble_rad =
        wobble_rad_[0] * std::cos(r.target_rad) + wobble_rad_[1] * std::sin(3.0 * r.target_rad);
    const double shift_rad = r.phase == Phase::kCalibration
                                 ? 0.0
                                 : r.target_rad + r.reference_rad;  // the mirror is clamped anew to face +y again
    return AngleAxisd(wobble_rad, Vector3d::UnitX()) *
           AngleAxisd(r.target_rad + Turntable(r.target_rad) + extra_rad, Vector3d::UnitZ()) *
           AngleAxisd(tilt_rad, across) *
           AngleAxisd(r.reference_rad + teeth_rad_[index] + seated_rad_, Vector3d::UnitZ()) *
           AngleAxisd(-shift_rad, Vector3d::UnitZ()) * AngleAxisd(mirror_rad_, Vector3d::UnitX()) *
           Vector3d::UnitY();
  }

  double Body(const Reading& r) const {
    const auto& p = TurntableOf(s_).turntable_procedure;
    const double e_m = TurntableProcedureSettings::Of(p.eccentricities_m, r.setup);
    const double to_x = std::cos(TurntableProcedureSettings::Of(p.tilt_azimuths_rad, r.setup) + r.target_rad);
    // A hollow mirror that stands to the right (+x) of the beam is met on its left, where it looks to the right.
    const double flat_rad = -8.0 * (wrong_.sag_m + TurntableOf(s_).mirror.flatness_m) * e_m * to_x /
                            std::pow(TurntableOf(s_).mirror.width_m, 2);
    const double late_rad = wrong_.settling_rad * std::exp(-(kLift_s - kMove_s + r.dwell_s) / wrong_.settling_s);
    return flat_rad - r.direction * (0.5 * wrong_.backlash_rad + late_rad);
  }

  Eigen::Vector2d Zero(const Reading& r) const {
    const double t = ToSeconds(r.time);
    Eigen::Vector2d zero;
    for (std::size_t a = 0; a < 2; ++a) {
      const double drift = wrong_.drift_rad_s[a] * t;
      const double creep = wrong_.creep_rad[a] * std::log(1.0 + (t - mounted_s_) / wrong_.creep_s);
      const double slip = r.reading >= wrong_.slip_at ? wrong_.slip_rad[a] : 0.0;
      const double tone = wrong_.tone_rad[a] * (1.0 + wrong_.modulation * std::sin(t / 2000.0)) *
                          std::cos(2.0 * kPi * t / wrong_.tone_s + wrong_.tone_phase_rad);
      const double warm = wrong_.kelvin_rad[a] * Room_K(t - wrong_.lag_s);
      zero[static_cast<Eigen::Index>(a)] = drift + creep + slip + tone + warm;
    }
    return wrong_.other ? Eigen::Vector2d(zero + wrong_.other(r)) : zero;
  }
  /// The mirror never faces the autocollimator quite the same way twice.
  Eigen::Vector2d Mounted(int setup) const {
    return {constants_rad_[2 * Number(setup)], constants_rad_[2 * Number(setup) + 1]};
  }
  static std::size_t Number(int setup) { return static_cast<std::size_t>(setup); }

  void Take(Reading& r) {
    const auto& dwells = TurntableOf(s_).turntable_procedure.dwell_s;
    r.reading = static_cast<int>(readings_.size());
    r.dwell_s = dwells[static_cast<std::size_t>(truth_.Uniform() * static_cast<double>(dwells.size()))];
    now_s_ += kLift_s + r.dwell_s + 0.2 * truth_.Uniform();
    r.time = Time(FromSeconds(now_s_));
    r.temperature_degC = s_.environment.reference_degC + Room_K(now_s_);
    const double stated_rad =
        TurntableOf(s_).multitooth_table.repeatability_sd[static_cast<std::size_t>(Component::kEz)];
    seated_rad_ = (s_.noise_free ? 0.0 : stated_rad * noise_.Normal()) + wrong_.seating_rad * noise_.Normal();
    const Eigen::Vector3d n = Normal(r, Body(r));
    const Eigen::Vector2d true_rad =
        Eigen::Vector2d(std::atan2(-n.x(), n.y()), std::asin(n.z())) + Mounted(r.setup);
    const double g = TurntableOf(s_).collimator.roll_rad + wrong_.roll_rad;
    Eigen::Vector2d shown(true_rad.x() * std::cos(g) + true_rad.y() * std::sin(g),
                          true_rad.y() * std::cos(g) - true_rad.x() * std::sin(g));
    shown *= 1.0 + TurntableOf(s_).autocollimator.gain_error + wrong_.gain_error;
    const Eigen::Array2d part = shown.array() / TurntableOf(s_).autocollimator.range_rad;
    shown.array() += wrong_.at_edge_rad * part * (part.square() + 0.05 * part.square().square());
    for (Eigen::Index a = 0; a < 2; ++a)
      shown[a] += wrong_.ripple_rad[Number(static_cast<int>(a))] *
                  std::cos(2.0 * kPi * shown[a] / wrong_.ripple_period_rad + wrong_.ripple_phase_rad);
    shown += Zero(r);
    const double sd_rad = s_.noise_free ? 0.0 : TurntableOf(s_).autocollimator.noise_rad;
    shown += Eigen::Vector2d(sd_rad * noise_.Normal(), sd_rad * noise_.Normal());
    if (noise_.Uniform() < wrong_.spoilt)
      shown[noise_.Uniform() < 0.5 ? 0 : 1] += wrong_.spoilt_rad * (1.0 + noise_.Uniform());
    r.autocollimator_yaw_rad = shown[0];
    r.autocollimator_tilt_rad = shown[1];
    readings_.push_back(r);
  }

  Scenario s_;
  Wrong wrong_;
  Stream truth_, noise_;
  std::vector<std::array<double, 2>> waves_;
  std::array<double, 360> teeth_rad_{};
  std::array<double, 2> wobble_rad_{};
  std::array<double, 3> room_{};
  std::array<double, 16> constants_rad_{};
  double mirror_rad_ = 0.0, seated_rad_ = 0.0, now_s_ = 0.0, mounted_s_ = 0.0;
  std::vector<Reading> readings_;
};

inline std::vector<Reading> BenchReadings(const Scenario& scenario, const Wrong& wrong, std::uint64_t seed) {
  return Bench(scenario, wrong, seed).Run();
}

}  // namespace twinbench::diagnose::test
