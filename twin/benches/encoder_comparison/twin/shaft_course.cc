#include "twin/benches/encoder_comparison/twin/shaft_course.h"

#include <algorithm>
#include <cmath>

#include "twin/model/motion.h"

namespace twinbench::sim {

void ShaftCourse::Add(const AngleMoment& moment) {
  points_.push_back({ToSeconds(moment.now), moment.shaft_rad, moment.velocity_rad_s, moment.goes, moment.gains_rad_s2});
}

double ShaftCourse::Between_rad(const Point& a, const Point& b, double time_s) {
  const double step_s = b.time_s - a.time_s, x = (time_s - a.time_s) / step_s, y = 1.0 - x;
  return y * y * (1.0 + 2.0 * x) * a.angle_rad + x * x * (1.0 + 2.0 * y) * b.angle_rad +
         x * y * step_s * (y * a.velocity_rad_s - x * b.velocity_rad_s);
}

/// Before the first reading the speed was as it is there.
double ShaftCourse::At_rad(double time_s) const {
  const auto after = std::ranges::lower_bound(points_, time_s, {}, &Point::time_s);
  if (after != points_.begin()) return Between_rad(*std::prev(after), *after, time_s);
  return after->angle_rad + after->velocity_rad_s * (time_s - after->time_s);
}

double ShaftCourse::Speed_rad_s(double time_s) const {
  const auto after = std::ranges::lower_bound(points_, time_s, {}, &Point::time_s);
  if (after == points_.begin()) return after->velocity_rad_s;
  const Point& before = *std::prev(after);
  return std::lerp(before.velocity_rad_s, after->velocity_rad_s,
                   (time_s - before.time_s) / (after->time_s - before.time_s));
}

/// On the way from reading k - 1 to k. Behind a gap, where a pass begins, its speed is there already.
double ShaftCourse::Acceleration_rad_s2(std::size_t k) const {
  const Point &a = points_[k - 1], &b = points_[k];
  if (std::isfinite(b.gains_rad_s2)) return b.gains_rad_s2;
  if (k > 1 && b.time_s - a.time_s > model::kLongestStep * (a.time_s - points_[k - 2].time_s)) return 0.0;
  return b.time_s > a.time_s ? (b.velocity_rad_s - a.velocity_rad_s) / (b.time_s - a.time_s) : 0.0;
}

void ShaftCourse::ReadEarlier(double age_s, AngleMoment& read) const {
  if (points_.size() < 2) return;
  const auto middle_s = [this](std::size_t k) { return 0.5 * (points_[k - 1].time_s + points_[k].time_s); };
  const double time_s = points_.back().time_s - std::max(0.0, age_s);
  std::size_t k = points_.size() - 1;
  while (k > 1 && middle_s(k) > time_s) --k;
  read.acceleration_rad_s2 = Acceleration_rad_s2(k);
  if (k + 1 < points_.size() && middle_s(k) <= time_s)
    read.acceleration_rad_s2 = std::lerp(read.acceleration_rad_s2, Acceleration_rad_s2(k + 1),
                                         (time_s - middle_s(k)) / (middle_s(k + 1) - middle_s(k)));
  read.goes = points_[points_[k].time_s <= time_s ? k : k - 1].goes;
}

double ShaftCourse::Beside_rad(const AngleMoment& moment, double age_s) const {
  const double now_s = ToSeconds(moment.now);
  if (age_s > 0.0) return At_rad(now_s - age_s) - moment.shaft_rad;
  const double gained_rad_s = moment.velocity_rad_s - Speed_rad_s(now_s + age_s);
  return -age_s * (moment.velocity_rad_s + 0.5 * gained_rad_s);
}

}  // namespace twinbench::sim
