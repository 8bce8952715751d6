#include "mechanics/feed_course.h"

#include <algorithm>
#include <cmath>

#include "mechanics/require.h"

namespace twinbench::mechanics {
namespace {

constexpr double kApart_s = 2e-3;
constexpr double kStill_m = 1e-12;  // by which a cubic would hardly differ from a straight line

}  // namespace

FeedCourse::FeedCourse(FeedDrive& drive, CircleAxis axis, const std::vector<FeedLeg>& legs) {
  const auto knot_of = [&](const CircleMotion& motion) {
    const FeedState state = drive.State();
    const CircleMotion::Point command = motion.At(axis, state.time_s);
    return Knot{state.time_s, state.slide_m - command.m, state.slide_m_s - command.m_s};
  };
  for (const FeedLeg& leg : legs) {
    drive.Command(leg.motion);
    if (knots_.empty()) knots_.push_back(knot_of(leg.motion));
    while (drive.time_s() < leg.until_s) {
      const double before_s = drive.time_s();
      drive.Step(leg.until_s);
      Keep(knot_of(leg.motion), drive.time_s() > before_s + 1.5 * drive.parameters().servo_period_s);
    }
    if (left_out_) knots_.push_back(last_);  // no cubic goes across a change of command
    left_out_ = false;
  }
}

void FeedCourse::Keep(const Knot& now, bool leapt) {
  const Knot& kept = knots_.back();
  const double gone_s = now.time_s - kept.time_s;
  const bool still = gone_s * std::abs(now.off_m_s - kept.off_m_s) < kStill_m;
  if (!leapt && (gone_s < kApart_s || still)) {
    last_ = now;
    left_out_ = true;
    return;
  }
  if (left_out_ && (leapt || gone_s > 2.0 * kApart_s)) knots_.push_back(last_);
  knots_.push_back(now);
  left_out_ = false;
}

double FeedCourse::Off_m(double time_s) const {
  Require(time_s >= knots_.front().time_s && time_s <= knots_.back().time_s,
          "feed course: asked for a time that it does not cover");
  const auto after = std::ranges::lower_bound(knots_, time_s, {}, &Knot::time_s);
  if (after->time_s == time_s) return after->off_m;
  const Knot &a = *(after - 1), &b = *after;
  const double h_s = b.time_s - a.time_s, s = (time_s - a.time_s) / h_s, rest = 1.0 - s;
  return a.off_m + s * s * (3.0 - 2.0 * s) * (b.off_m - a.off_m) +
         s * rest * h_s * (rest * a.off_m_s - s * b.off_m_s);
}

}  // namespace twinbench::mechanics
