#include "twin/benches/circular_motion/procedure.h"

#include <cmath>

#include "twin/benches/circular_motion/columns.h"

namespace twinbench::procedure {
namespace {

using namespace benches::circular;

constexpr double kLeadIn_s = 60.0;  // half a circle at the feeds of such tests, or the way back to the start

/// Adds readings in time order.
class Circles {
 public:
  explicit Circles(const CircularProcedureSettings& procedure) : s_(procedure) {}

  std::vector<Reading> Make() {
    for (std::size_t setup = 0; setup < s_.setups.size(); ++setup) {
      if (setup > 0) time_s_ += s_.remount_s;
      AddSetup(static_cast<int>(setup));
    }
    return readings_;
  }

 private:
  void AddSetup(int setup) {
    const double radius_m = s_.setups[static_cast<std::size_t>(setup)].radius_m;
    pass_ = 0;
    for (const double feed_m_s : s_.feeds_m_s) {
      const double step_s = units::turn / s_.points * radius_m / feed_m_s;
      for (const int direction : s_.directions) AddSweep(setup, direction, radius_m, feed_m_s, step_s);
    }
    if (s_.stops == 0) return;
    for (const int direction : s_.directions) AddStops(setup, direction, radius_m);
  }

  void AddSweep(int setup, int direction, double radius_m, double feed_m_s, double step_s) {
    time_s_ += kLeadIn_s;
    for (int k = 0; k < s_.points; ++k) {
      if (k > 0) time_s_ += step_s;
      Add(setup, direction, k, s_.points, radius_m, feed_m_s);
    }
    ++pass_;
  }

  /// Also to the first one the axes have gone one step, and stand.
  void AddStops(int setup, int direction, double radius_m) {
    const double step_s = units::turn / s_.stops * radius_m / s_.rapid_m_s + s_.dwell_s;
    time_s_ += kLeadIn_s;
    for (int k = 0; k < s_.stops; ++k) {
      time_s_ += step_s;
      Add(setup, direction, k, s_.stops, radius_m, 0.0);
    }
    ++pass_;
  }

  void Add(int setup, int direction, int k, int count, double radius_m, double feed_m_s) {
    Reading& r = readings_.emplace_back();
    r.reading = static_cast<int>(readings_.size()) - 1;
    r.time = Time(FromSeconds(time_s_));
    r.setup = setup;
    r.pass = pass_;
    r.direction = direction;
    r.position = direction > 0 ? k : (count - k) % count;
    r.target_rad = s_.start_rad + direction * units::turn * k / count;
    kCommandedX_m(r) = radius_m * std::cos(r.target_rad);
    kCommandedY_m(r) = radius_m * std::sin(r.target_rad);
    kFeed_m_s(r) = feed_m_s;
  }

  const CircularProcedureSettings& s_;
  std::vector<Reading> readings_;
  double time_s_ = 0.0;
  int pass_ = 0;
};

}  // namespace

std::vector<Reading> CircleSchedule(const CircularProcedureSettings& procedure) {
  return Circles(procedure).Make();
}

}  // namespace twinbench::procedure
