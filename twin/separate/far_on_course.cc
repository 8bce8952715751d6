#include "twin/separate/far_on_course.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include "twin/core/robust_scale.h"
#include "twin/core/units.h"

namespace twinbench::separate {
namespace {

constexpr std::size_t kNeighbours = 4, kFewestOfPass = 20;

/// Off the cubic through its nearest neighbours, however they are spaced, and the same alike for all if the noise is.
struct OffCurve {
  double off, spike;
};

class Course {
 public:
  explicit Course(std::vector<OnCourse> readings) : readings_(std::move(readings)) {
    for (std::size_t i = 0; i < Size(); ++i) off_.push_back(OffAt(i));
  }

  std::size_t Size() const { return readings_.size(); }
  const OnCourse& At(std::size_t i) const { return readings_[i]; }
  const OffCurve& Off(std::size_t i) const { return off_[i]; }

  std::size_t Farthest() const {
    const auto size = [](const OffCurve& o) { return std::abs(o.spike); };
    return static_cast<std::size_t>(std::ranges::max_element(off_, {}, size) - off_.begin());
  }

  /// Of all, by the median; no less than a step of what was read.
  double Scatter(double least) const {
    std::vector<double> spikes;
    double step = INFINITY;
    for (std::size_t i = 0; i < Size(); ++i) {
      spikes.push_back(off_[i].spike);
      const double change = i > 0 ? std::abs(readings_[i].value - readings_[i - 1].value) : 0.0;
      if (change > 1e-3 * least) step = std::min(step, change);
    }
    return std::max({RobustDeviation(std::move(spikes)), std::isfinite(step) ? step : 0.0, least});
  }

  double Step_rad(std::size_t i) const {
    const std::size_t next = i + 1 < Size() ? i + 1 : i - 1;
    return std::abs(std::remainder(readings_[next].angle_rad - readings_[i].angle_rad, units::turn));
  }

  Course Without(std::size_t i) const {
    std::vector<OnCourse> others = readings_;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    return Course(std::move(others));
  }

 private:
  OffCurve OffAt(std::size_t i) const {
    const std::size_t half = kNeighbours / 2, last_first = Size() - kNeighbours - 1;
    const std::size_t first = std::min(i < half ? 0 : i - half, last_first);
    double between = 0.0, squares = 1.0;
    for (std::size_t k = first; k <= first + kNeighbours; ++k) {
      if (k == i) continue;
      double weight = 1.0;
      for (std::size_t other = first; other <= first + kNeighbours; ++other) {
        if (other != i && other != k)
          weight *= (readings_[i].angle_rad - readings_[other].angle_rad) / (readings_[k].angle_rad - readings_[other].angle_rad);
      }
      between += weight * readings_[k].value;
      squares += weight * weight;
    }
    const double off = readings_[i].value - between;
    if (!std::isfinite(off)) return {0.0, 0.0};  // two at one angle
    return {off, off / std::sqrt(squares)};
  }

  std::vector<OnCourse> readings_;
  std::vector<OffCurve> off_;
};

constexpr double kAlike = 0.3;  // of a spike

/// A step leaves as much at the next reading when one is taken out.
bool NeighboursAgree(const Course& without, std::size_t i, double spike) {
  const std::size_t end = std::min(i + 2, without.Size());
  for (std::size_t k = i < 2 ? 0 : i - 2; k < end; ++k)
    if (std::abs(without.Off(k).spike) > kAlike * std::abs(spike)) return false;
  return true;
}

using CoursesThatWay = std::vector<const Course*>;

/// Whether another turn shows there what this one does, or there is none and the axis may do so.
bool IsOfTheAxis(const CoursesThatWay& that_way, const Course& pass, std::size_t i, const MayBeThere& may_be_there) {
  constexpr double kNear = 1.5;  // steps
  const OnCourse& at = pass.At(i);
  bool is_read_again = false;
  for (const Course* other : that_way) {
    for (std::size_t k = 0; k < other->Size(); ++k) {
      const OnCourse& again = other->At(k);
      const bool is_near = std::abs(std::remainder(again.angle_rad - at.angle_rad, units::turn)) <= kNear * pass.Step_rad(i);
      if (!is_near || std::abs(again.reading - at.reading) <= 2) continue;
      if (std::abs(other->Off(k).spike) > kAlike * std::abs(pass.Off(i).spike)) return true;
      is_read_again = true;
    }
  }
  return !is_read_again && may_be_there(at.angle_rad, pass.Step_rad(i));
}

/// @return nothing where they are too many.
std::vector<FarOnCourse> FarOf(Course pass, const CoursesThatWay& that_way, double least, const MayBeThere& may_be_there) {
  constexpr double kFar = 8.0, kMostShare = 0.005;  // scatters; of all readings
  constexpr std::size_t kFewestMost = 2, kMost = 20;
  const double scatter = pass.Scatter(least);
  const std::size_t most = std::clamp(static_cast<std::size_t>(kMostShare * static_cast<double>(pass.Size())), kFewestMost, kMost);
  std::vector<FarOnCourse> far;
  while (pass.Size() >= kFewestOfPass) {
    const std::size_t worst = pass.Farthest();
    const OffCurve off = pass.Off(worst);
    Course without = pass.Without(worst);
    if (std::abs(off.spike) < kFar * scatter || !NeighboursAgree(without, worst, off.spike) || IsOfTheAxis(that_way, pass, worst, may_be_there)) break;
    if (far.size() == most) return {};
    const OnCourse& at = pass.At(worst);
    far.push_back({at.reading, at.angle_rad, off.off, std::abs(off.spike) / scatter});
    pass = std::move(without);
  }
  return far;
}

}  // namespace

std::vector<FarOnCourse> FarOnCourses(std::vector<std::vector<OnCourse>> passes, double least, const MayBeThere& may_be_there) {
  std::vector<Course> courses;
  for (std::vector<OnCourse>& pass : passes)
    if (pass.size() >= kFewestOfPass) courses.emplace_back(std::move(pass));
  CoursesThatWay all;
  for (const Course& course : courses) all.push_back(&course);
  std::vector<FarOnCourse> far;
  for (const Course& course : courses) std::ranges::copy(FarOf(course, all, least, may_be_there), std::back_inserter(far));
  return far;
}

std::vector<FarOnCourse> TakeOutFar(std::vector<Reading>& readings, const std::function<std::optional<OnCourse>(const Reading&)>& on_course,
                                    double least, const MayBeThere& may_be_there) {
  std::map<std::pair<int, int>, std::map<int, std::vector<OnCourse>>> that_way;  // set-up and direction; pass
  for (const Reading& r : readings) {
    const std::optional<OnCourse> at = r.status == ReadingStatus::kOk ? on_course(r) : std::nullopt;
    if (at && std::isfinite(at->value)) that_way[{r.setup, r.direction}][r.pass].push_back(*at);
  }
  std::vector<FarOnCourse> far;
  for (auto& [way, by_pass] : that_way) {
    std::vector<std::vector<OnCourse>> passes;
    for (auto& [number, pass] : by_pass) passes.push_back(std::move(pass));
    std::ranges::copy(FarOnCourses(std::move(passes), least, may_be_there), std::back_inserter(far));
  }
  std::set<int> numbers;
  for (const FarOnCourse& one : far) numbers.insert(one.reading);
  std::erase_if(readings, [&](const Reading& r) { return numbers.contains(r.reading); });
  return far;
}

}  // namespace twinbench::separate
