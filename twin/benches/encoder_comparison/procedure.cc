#include "twin/benches/encoder_comparison/procedure.h"

#include <algorithm>
#include <cmath>

#include "twin/benches/encoder_comparison/settings.h"

namespace twinbench::procedure {
namespace {

/// Where the shaft is during one pass of a sweep, from its start: speed up, keep the speed, slow down, rest.
struct SweepPass {
  double speed_rad_s, ramp_s, cruise_s;

  double Motion_s() const { return 2.0 * ramp_s + cruise_s; }
  double Length_rad() const { return speed_rad_s * (ramp_s + cruise_s); }

  double Travel_rad(double t_s) const {
    if (t_s >= Motion_s()) return Length_rad();
    if (t_s > ramp_s + cruise_s) return Length_rad() - RampTravel_rad(Motion_s() - t_s);
    return t_s < ramp_s ? RampTravel_rad(t_s) : speed_rad_s * (t_s - 0.5 * ramp_s);
  }
  double Speed_rad_s(double t_s) const {
    const double share = std::min(t_s, Motion_s() - t_s) / ramp_s;
    return speed_rad_s * std::clamp(share, 0.0, 1.0);
  }

 private:
  double RampTravel_rad(double t_s) const { return 0.5 * speed_rad_s * t_s * t_s / ramp_s; }
};

/// Adds readings in time order.
class Schedule {
 public:
  explicit Schedule(const EncoderProcedureSettings& procedure) : s_(procedure), shaft_rad_(procedure.start_rad) {}

  std::vector<Reading> Make() {
    for (std::size_t k = 0; k < s_.mounting_rad.size(); ++k) {
      if (k > 0) time_s_ += s_.remount_s;
      if (s_.kind == "stops") AddStops(static_cast<int>(k));
      if (s_.kind == "sweep") AddSweeps(static_cast<int>(k));
      if (s_.kind == "coast") AddCoasts(static_cast<int>(k));
    }
    return readings_;
  }

 private:
  /// One reading of every head. Where there are several they are set-ups of their own: nothing is known of the
  /// zero of one against that of another.
  void Add(int mounting, int direction, int position, double angle_rad, double velocity_rad_s, double time_s) {
    const auto heads = static_cast<int>(s_.heads_rad.size());
    for (int head = 0; head < heads; ++head) {
      AddOne(mounting * heads + head, direction, position, angle_rad, velocity_rad_s, time_s);
      if (heads > 1) readings_.back().head_rad = s_.heads_rad[static_cast<std::size_t>(head)];
    }
  }

  void AddOne(int setup, int direction, int position, double angle_rad, double velocity_rad_s, double time_s) {
    Reading reading;
    reading.reading = static_cast<int>(readings_.size());
    reading.time = Time(FromSeconds(time_s));
    reading.setup = setup;
    reading.pass = pass_;
    reading.direction = direction;
    reading.position = position;
    reading.reference_rad = angle_rad;
    reading.velocity_rad_s = velocity_rad_s;
    readings_.push_back(reading);
  }

  void AddStops(int mounting) {
    const int count = std::max(1, static_cast<int>(std::lround(s_.turns * s_.stops)));
    for (const int direction : s_.passes) {
      for (int k = 0; k < count; ++k) {
        const int position = direction > 0 ? k : count - 1 - k;
        Add(mounting, direction, position, s_.start_rad + position * units::turn / s_.stops, 0.0, time_s_);
        time_s_ += s_.stop_interval_s;
      }
      ++pass_;
    }
  }

  void AddSweeps(int mounting) {
    for (const double speed_rad_s : s_.speeds_rad_s) {
      for (const int direction : s_.passes) AddSweep(mounting, direction, speed_rad_s);
    }
  }

  /// Times are those of a spindle that loses nothing: the bench knows the others.
  void AddCoasts(int mounting) {
    const int count = static_cast<int>(std::lround(s_.turns * s_.stamps));
    const double step_rad = units::turn / s_.stamps;
    for (const double speed_rad_s : s_.speeds_rad_s) {
      for (const int direction : s_.passes) {
        for (int k = 0; k <= count; ++k) {
          const double line_rad = s_.start_rad + direction * k * step_rad;
          Add(mounting, direction, k, line_rad, direction * speed_rad_s, time_s_ + k * step_rad / speed_rad_s);
          readings_.back().measured_rad = line_rad;
        }
        time_s_ += count * step_rad / speed_rad_s + s_.rest_s;
        ++pass_;
      }
    }
  }

  void AddSweep(int mounting, int direction, double speed_rad_s) {
    const SweepPass pass{speed_rad_s, s_.ramp_s, s_.turns * units::turn / speed_rad_s};
    const int count = static_cast<int>(std::ceil((pass.Motion_s() + s_.rest_s) / s_.interval_s));
    for (int k = 0; k < count; ++k) {
      const double t_s = k * s_.interval_s;
      const double velocity_rad_s = direction * pass.Speed_rad_s(t_s) + 0.0;  // at rest without a sign
      Add(mounting, velocity_rad_s == 0.0 ? 0 : direction, k, shaft_rad_ + direction * pass.Travel_rad(t_s),
          velocity_rad_s, time_s_ + t_s);
    }
    time_s_ += count * s_.interval_s;
    shaft_rad_ += direction * pass.Length_rad();
    ++pass_;
  }

  const EncoderProcedureSettings& s_;
  std::vector<Reading> readings_;
  double shaft_rad_;
  double time_s_ = 0.0;
  int pass_ = 0;
};

}  // namespace

std::vector<Reading> AngleSchedule(const EncoderProcedureSettings& procedure) {
  return Schedule(procedure).Make();
}

void CarryOut(AngleComparator& bench, const Scenario& scenario, ReadingSink& sink,
              const ProgressCallback& progress) {
  // In motion readings come too fast to be waited for one by one.
  const std::size_t together = EncoderOf(scenario).encoder_procedure.kind == "stops" ? 1 : 256;
  const std::vector<Reading> schedule = AngleSchedule(EncoderOf(scenario).encoder_procedure);
  std::vector<Reading> taken;
  for (Reading reading : schedule) {
    bench.Take(reading);
    taken.push_back(reading);
    const bool last = reading.reading + 1 == std::ssize(schedule);
    if (taken.size() < together && !last) continue;
    sink.AppendAll(taken);
    taken.clear();
    if (progress) progress({reading.reading + 1, static_cast<int>(schedule.size()), reading.phase, reading.time});
  }
}

}  // namespace twinbench::procedure
