#pragma once

#include <map>
#include <string>
#include <vector>

#include "twin/benches/hob_transmission/settings.h"
#include "twin/benches/names.h"
#include "twin/core/reading.h"
#include "twin/core/stream.h"
#include "twin/core/units.h"

/// Readings of a hobbing machine by formulas of the tests' own: the samples are found along the way of the table,
/// rings are circles off their shaft, the hob's signals are a point in a plane, play and torsion follow the path
/// with its ramps. Diagnosis knows all of this to first order only.
namespace twinbench::diagnose::test {

using units::arcsec, units::deg, units::kPi;

inline constexpr double kRatio = 2.0 / 44.0;
inline constexpr double kTurn_rad = 2.0 * kPi;
inline constexpr double kRamp_s = 2.0, kRest_s = 2.0;
inline constexpr int kHobLines = 9000, kHobSteps = 100;

/// One hidden cause of the catalogue, parameters in SI.
struct HiddenCause {
  std::string name, where;
  std::map<std::string, double> value;
};

struct HobChain {
  std::vector<double> heads_deg = {0.0, 177.0};
  std::vector<double> hob_speeds_rev_min = {50.0};
  std::vector<int> passes = {1, -1};
  int turns = 3;
  int samples_per_turn = 720;
  double remount_s = 1800.0;
  bool interferometer = false;
  double table_noise_arcsec = 0.1;
  double hob_noise_arcsec = 0.5;
  double interferometer_noise_arcsec = 0.02;
  bool hob_steps = true;  // the hob's encoder counts whole steps, a hundredth of a line
  bool noise_told = true;
  std::uint64_t seed = 1;
  std::vector<HiddenCause> hidden = {};
};

/// Everything that happens along the way of one chain.
class Machine {
 public:
  explicit Machine(const HobChain& chain) : chain_(chain), noise_(chain.seed, "hob.noise") {
    Stream stream(chain.seed, "hob.transmission");
    for (int k = 1; k <= 4; ++k) {
      amplitude_rad_.push_back(8.0 * arcsec * stream.Uniform() / k);
      phase_rad_.push_back(kTurn_rad * stream.Uniform());
    }
  }

  std::vector<Reading> Run() {
    for (std::size_t setup = 0; setup < chain_.heads_deg.size(); ++setup) {
      if (setup > 0) now_s_ += chain_.remount_s;
      setup_ = static_cast<int>(setup);
      for (const double speed : chain_.hob_speeds_rev_min) {
        for (const int direction : chain_.passes) Pass(direction, speed * kTurn_rad / 60.0 * kRatio);
      }
    }
    Disturb();
    return std::move(readings_);
  }

 private:
  double Of(const HiddenCause& h, const char* name, double otherwise = 0.0) const {
    const auto found = h.value.find(name);
    return found == h.value.end() ? otherwise : found->second;
  }

  /// Sum over the hidden causes of that name and place.
  double Sum(const std::string& name, const std::string& where,
             const std::function<double(const HiddenCause&)>& f) const {
    double sum = 0.0;
    for (const HiddenCause& h : chain_.hidden) {
      if (h.name == name && h.where == where) sum += f(h);
    }
    return sum;
  }

  double WaveOf(const HiddenCause& h, double angle_rad, double order) const {
    return Of(h, "amplitude") * std::cos(order * angle_rad + Of(h, "phase"));
  }

  /// A circle of radius 1 whose middle is off the shaft by the amplitude: the angle under which a point of it is
  /// seen. To first order amplitude * cos(angle + phase).
  static double OffCentre_rad(double amplitude, double angle_rad) {
    return std::atan2(amplitude * std::cos(angle_rad), 1.0 + amplitude * std::sin(angle_rad));
  }

  double RingError_rad(const std::string& where, double s_rad) const {
    return Sum("eccentricity", where,
               [&](const HiddenCause& h) { return OffCentre_rad(Of(h, "amplitude"), s_rad + Of(h, "phase")); }) +
           Sum("ellipticity", where, [&](const HiddenCause& h) { return WaveOf(h, s_rad, 2.0); }) +
           Sum("periodic", where, [&](const HiddenCause& h) { return WaveOf(h, s_rad, Of(h, "order")); });
  }

  /// Moves play and torsion along a piece of the table's way.
  void Travel(double to_rad) {
    const double way_rad = to_rad - at_rad_, sense = way_rad < 0.0 ? -1.0 : 1.0;
    for (const HiddenCause& h : chain_.hidden) {
      if (h.name == "hysteresis")
        torsion_ = sense + (torsion_ - sense) * std::exp(-std::abs(way_rad) / Of(h, "settles_over"));
      if (h.name != "backlash") continue;
      const double half_rad = 0.5 * std::abs(Of(h, "width"));
      play_rad_ = std::clamp(play_rad_ - way_rad, -half_rad, half_rad);
    }
    at_rad_ = to_rad;
  }

  /// What the table does against the hob.
  double Motion_rad(double th_rad, double hob_rad) const {
    double e_rad = 0.0;
    for (std::size_t k = 0; k < amplitude_rad_.size(); ++k)
      e_rad += amplitude_rad_[k] * std::cos(static_cast<double>(k + 1) * th_rad + phase_rad_[k]);
    for (const HiddenCause& h : chain_.hidden) {
      if (h.name == "hob_runout") e_rad += WaveOf(h, hob_rad, 1.0);
      if (h.name == "worm") e_rad += WaveOf(h, th_rad, 90.0);
      if (h.name == "gear_mesh") e_rad += WaveOf(h, th_rad, 44.0);
      if (h.name == "backlash") e_rad += play_rad_ * (Of(h, "width") < 0.0 ? -1.0 : 1.0);
      if (h.name == "hysteresis") e_rad -= Of(h, "lag") * torsion_;
      if (h.name == "drift") {
        const double hours = now_s_ / 3600.0;
        e_rad += Of(h, "rate") * now_s_ * (1.0 + Of(h, "curvature") * (1.0 - hours));
      }
      if (h.name == "tone") e_rad += WaveOf(h, kTurn_rad * Of(h, "frequency") * now_s_, 1.0);
    }
    return e_rad;
  }

  /// Error of the angle that the hob's faulty signals show.
  double SignalError_rad(double hob_rad) const {
    double sin_offset = 0.0, cos_offset = 0.0, gain = 1.0, lead_rad = 0.0;
    for (const HiddenCause& h : chain_.hidden) {
      sin_offset += Of(h, "offset_sin");
      cos_offset += Of(h, "offset_cos");
      if (h.name == "amplitude_mismatch") gain += Of(h, "ratio");
      if (h.name == "quadrature_error") lead_rad += Of(h, "angle");
    }
    const double p = kHobLines * hob_rad;
    const double shown = std::atan2(gain * std::sin(p + lead_rad) + sin_offset, std::cos(p) + cos_offset);
    return std::remainder(shown - p, kTurn_rad) / kHobLines;
  }

  void Pass(int direction, double speed_rad_s) {
    const double v = direction * speed_rad_s, run_up_rad = 0.5 * v * kRamp_s;
    const double edge_rad = kTurn_rad / chain_.samples_per_turn;
    now_s_ += kRamp_s;
    Travel(at_rad_ + run_up_rad);
    const double first =
        direction > 0 ? std::ceil(at_rad_ / edge_rad + 0.01) : std::floor(at_rad_ / edge_rad - 0.01);
    for (int i = 0; i < chain_.turns * chain_.samples_per_turn; ++i)
      Sample((first + direction * i) * edge_rad, v, direction, i);
    now_s_ += kRamp_s + kRest_s;
    Travel(at_rad_ + run_up_rad);
    ++pass_;
  }

  /// The edge of the table's encoder at `encoder_rad`.
  void Sample(double encoder_rad, double v, int direction, int position) {
    const double head_rad = chain_.heads_deg[static_cast<std::size_t>(setup_)] * deg;
    const double late_rad = v * Sum("latency", "", [&](const HiddenCause& h) { return Of(h, "delay"); });
    double th_rad = encoder_rad - chain_.table_noise_arcsec * arcsec * noise_.Normal() + late_rad;
    th_rad -= RingError_rad("table", th_rad - head_rad);
    now_s_ += std::abs(th_rad - at_rad_) / std::abs(v);
    Travel(th_rad);
    double hob_rad = th_rad / kRatio, e_rad = 0.0;
    for (int round = 0; round < 3; ++round) {
      e_rad = Motion_rad(th_rad, hob_rad);
      hob_rad = (th_rad - e_rad) / kRatio;
    }
    Reading r{.reading = static_cast<int>(readings_.size()), .time = Time{} + FromSeconds(now_s_), .setup = setup_,
              .pass = pass_, .direction = direction, .position = position, .velocity_rad_s = v,
              .head_rad = head_rad};
    r.measured_rad = encoder_rad + Slipped_rad("table", r.reading);
    r.reference_rad = Shown_rad(hob_rad) + Slipped_rad("hob", r.reading);
    if (chain_.interferometer)
      r.interferometer_rad = e_rad + 30.0 * arcsec + chain_.interferometer_noise_arcsec * arcsec * noise_.Normal();
    readings_.push_back(r);
  }

  double Slipped_rad(const std::string& where, int reading) const {
    return Sum("slip", where,
               [&](const HiddenCause& h) { return reading >= Of(h, "at_reading") ? Of(h, "step") : 0.0; });
  }

  double Shown_rad(double hob_rad) {
    const double step_rad = kTurn_rad / kHobLines / kHobSteps;
    const double scale_rad = hob_rad + RingError_rad("hob", hob_rad) + SignalError_rad(hob_rad) +
                             chain_.hob_noise_arcsec * arcsec * noise_.Normal();
    return chain_.hob_steps ? (std::floor(scale_rad / step_rad) + 0.5) * step_rad : scale_rad;
  }

  void Disturb() {
    Stream stream(chain_.seed, "hob.outliers");
    for (const HiddenCause& h : chain_.hidden) {
      if (h.name != "outliers") continue;
      for (Reading& r : readings_) {
        const double hit = stream.Uniform(), size = stream.Normal();
        if (hit < Of(h, "fraction")) r.measured_rad += Of(h, "size") * size;
      }
    }
  }

  const HobChain& chain_;
  Stream noise_;
  std::vector<double> amplitude_rad_, phase_rad_;
  std::vector<Reading> readings_;
  double now_s_ = 0.0, at_rad_ = 0.0, torsion_ = 0.0, play_rad_ = 0.0;
  int setup_ = 0, pass_ = 0;
};

/// What is told of it: everything but the hidden causes and the free orders of the transmission error.
inline Scenario ScenarioOf(const HobChain& chain) {
  Scenario s;
  s.bench = kHobBench;
  HobOf(s).table_encoder.noise_rad = chain.noise_told ? chain.table_noise_arcsec * arcsec : 0.0;
  HobOf(s).hob_encoder.noise_rad = chain.noise_told ? chain.hob_noise_arcsec * arcsec : 0.0;
  HobOf(s).hob_encoder.lines = kHobLines;
  HobOf(s).hob_encoder.interpolation = kHobSteps;
  HobOf(s).interferometer.used = chain.interferometer;
  HobOf(s).interferometer.noise_rad = chain.interferometer_noise_arcsec * arcsec;
  HobOf(s).hob_procedure.heads_rad.clear();
  for (const double head_deg : chain.heads_deg) HobOf(s).hob_procedure.heads_rad.push_back(head_deg * deg);
  HobOf(s).hob_procedure.passes = chain.passes;
  HobOf(s).hob_procedure.turns = chain.turns;
  HobOf(s).hob_procedure.samples_per_turn = chain.samples_per_turn;
  HobOf(s).hob_procedure.ramp_s = kRamp_s;
  return s;
}

/// The transmission error has random waves of orders 1 to 4, and constants in every set-up, by the seed.
inline std::vector<Reading> ReadingsOf(const HobChain& chain) { return Machine(chain).Run(); }

}  // namespace twinbench::diagnose::test
