#include "twin/benches/hob_transmission/twin/course.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "twin/benches/hob_transmission/settings.h"

namespace twinbench::sim {
namespace {

class CourseMaker {
 public:
  CourseMaker(const std::vector<Reading>& record, HobPath& path)
      : record_(record), path_(path), procedure_(HobOf(path.actual()).hob_procedure) {}

  HobCourse Make() {
    FindZeros();
    for (std::size_t i = 0; i < record_.size(); ++i) course_.stops.push_back(StopOf(i));
    NoteUnfixed();
    return std::move(course_);
  }

 private:
  double Ratio() const { return HobOf(path_.actual()).transmission.Ratio(); }

  double Table_rad(const Reading& r) const {
    return r.measured_rad + (procedure_.encoder_zero == "table_origin" ? 0.0 : r.head_rad);
  }

  /// Both encoders of this bench count from where the chain began. If they do not, the table's angle is believed.
  void FindZeros() {
    constexpr double kSame_rad = 1e-3;  // errors are smaller
    std::map<int, std::pair<double, int>> sum;
    for (const Reading& r : record_) {
      const double m_rad = Table_rad(r) - Ratio() * r.reference_rad;
      if (!std::isfinite(m_rad)) continue;
      sum[r.setup].first += m_rad;
      ++sum[r.setup].second;
    }
    for (const auto& [setup, of] : sum) {
      const double mean_rad = of.first / of.second;
      if (std::abs(mean_rad) > kSame_rad) zero_rad_[setup] = mean_rad;
    }
  }

  HobStop StopOf(std::size_t i) {
    const Reading& r = record_[i];
    HobStop stop;
    const double velocity_rad_s = Velocity_rad_s(i);
    if (velocity_rad_s != 0.0) direction_ = velocity_rad_s > 0.0 ? 1 : -1;
    if (velocity_rad_s == 0.0 && r.direction != 0) direction_ = r.direction;  // it came to rest this way
    stop.direction = direction_;
    stop.hob_speed_rad_s = velocity_rad_s / Ratio();
    if (zero_rad_.contains(r.setup)) stop.zero_rad = zero_rad_.at(r.setup);
    if (i > 0) TurnRound(i - 1, i);
    const double table_rad = Table_rad(r);
    if (std::isfinite(table_rad)) path_.Travel(table_rad);
    stop.added = {r.time, 0.0, 0.0, velocity_rad_s, 0.0};
    path_.Disturb({r.time, r.reading, table_rad, velocity_rad_s}, stop.added);
    stop.hob_shown_rad = r.reference_rad - stop.added.hob_encoder_rad;
    return stop;
  }

  /// As recorded, else from the samples before and behind of the same pass.
  double Velocity_rad_s(std::size_t i) const {
    if (std::isfinite(record_[i].velocity_rad_s)) return record_[i].velocity_rad_s;
    const auto same = [&](std::size_t k) { return k < record_.size() && record_[k].pass == record_[i].pass; };
    const Reading& a = record_[i > 0 && same(i - 1) ? i - 1 : i];
    const Reading& b = record_[same(i + 1) ? i + 1 : i];
    const double step_s = ToSeconds(b.time - a.time);
    return step_s > 0.0 ? (b.measured_rad - a.measured_rad) / step_s : 0.0;
  }

  /// Behind a pass the table goes on until the computer has seen its last sample, and out over the ramp; before the
  /// next one it comes in over a ramp. Way and time between the samples tell how far that was.
  void TurnRound(std::size_t last, std::size_t first) {
    const Reading &a = record_[last], &b = record_[first];
    const double v_a = Velocity_rad_s(last), v_b = Velocity_rad_s(first), ramp_s = procedure_.ramp_s;
    if (a.pass == b.pass || !(v_a * v_b < 0.0)) return;
    const double waited_s = procedure_.rest_s + (a.setup != b.setup ? procedure_.remount_s : 0.0);
    const double steady_s = ToSeconds(b.time - a.time) - 2.0 * ramp_s - waited_s;
    const double way_rad = Table_rad(b) - Table_rad(a) - 0.5 * ramp_s * (v_a + v_b);
    const double on_s = std::clamp((way_rad - v_b * steady_s) / (v_a - v_b), 0.0, std::max(0.0, steady_s));
    const double turned_rad = Table_rad(a) + v_a * (on_s + 0.5 * ramp_s);
    if (std::isfinite(turned_rad)) path_.Travel(turned_rad);
  }

  void NoteUnfixed() {
    course_.unfixed.push_back("where the table turned round between passes: from times and [hob_procedure]");
    if (!zero_rad_.empty()) course_.unfixed.push_back("zero of the hob's encoder: by the mean of a mounting");
  }

  const std::vector<Reading>& record_;
  HobPath& path_;
  const HobProcedureSettings& procedure_;
  std::map<int, double> zero_rad_;
  int direction_ = 1;
  HobCourse course_;
};

}  // namespace

HobCourse FollowCourse(const std::vector<Reading>& record, HobPath& path) {
  return CourseMaker(record, path).Make();
}

}  // namespace twinbench::sim
