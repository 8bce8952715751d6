#include "twin/benches/rotary_4dof/estimators/far_readings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "twin/core/robust_scale.h"
#include "twin/core/units.h"

namespace twinbench::separate::rotary {
namespace {

/// Weights of four neighbours with which a cubic through them has the value between them, and the length of all five.
struct CubicBetween {
  std::array<int, 4> at;
  std::array<double, 4> weight;
};
constexpr CubicBetween kCubicInside{{-2, -1, 1, 2}, {-1.0 / 6.0, 4.0 / 6.0, 4.0 / 6.0, -1.0 / 6.0}};
constexpr CubicBetween kCubicSecond{{-1, 1, 2, 3}, {0.25, 1.5, -1.0, 0.25}};
constexpr CubicBetween kCubicFirst{{1, 2, 3, 4}, {4.0, -6.0, 4.0, -1.0}};
constexpr long kFewestOfPass = 20;  // readings of a pass

/// What one column showed in the passes of one setup, one pass behind the other.
class ProbeCourse {
 public:
  ProbeCourse(const std::vector<std::vector<Reading*>>& passes, const Quantity& column) {
    for (const std::vector<Reading*>& pass : passes) {
      std::vector<Reading*> own;
      std::ranges::copy_if(pass, std::back_inserter(own), [&](Reading* r) { return std::isfinite(column(std::as_const(*r))); });
      if (std::ssize(own) < kFewestOfPass) continue;
      begin_.insert(begin_.end(), own.size(), std::ssize(reading_));
      reading_.insert(reading_.end(), own.begin(), own.end());
      end_.insert(end_.end(), own.size(), std::ssize(reading_));
    }
    for (Reading* r : reading_) value_.push_back(column(std::as_const(*r)));
    for (long i = 0; i < Size(); ++i) spike_.push_back(SpikeOf(i));
  }

  long Size() const { return std::ssize(reading_); }
  Reading& At(long i) const { return *reading_[static_cast<std::size_t>(i)]; }
  double Spike(long i) const { return spike_[static_cast<std::size_t>(i)]; }

  /// Off the curve through the neighbours.
  double Off(long i) const {
    double between = 0.0;
    ForNeighbours(i, [&](long at, double weight) { between += weight * Value(at); });
    return Value(i) - between;
  }

  /// Of all, by the median; no less than a step of what was read.
  double Scatter() const {
    double step = INFINITY;
    for (long i = 1; i < Size(); ++i) {
      const double change = std::abs(Value(i) - Value(i - 1));
      if (change > 0.0) step = std::min(step, change);
    }
    return std::max(RobustDeviation(spike_), step);
  }

  /// Whether another turn shows there what this one does.
  /// @return false, too, only if there is another turn.
  bool IsOfEveryTurn(long i) const {
    constexpr double kAlike = 0.3;
    const double near_rad = 1.5 * StepAt(i);
    bool is_read_again = false;
    for (long other = 0; other < Size(); ++other) {
      if (std::abs(other - i) <= 2 ||
          std::abs(std::remainder(At(other).target_rad - At(i).target_rad, units::turn)) > near_rad)
        continue;
      if (std::abs(Spike(other)) > kAlike * std::abs(Spike(i))) return true;
      is_read_again = true;
    }
    return !is_read_again;
  }

  void Replace(long i) {
    value_[static_cast<std::size_t>(i)] -= Off(i);
    constexpr long kReach = 4;
    for (long at = std::max(0L, i - kReach); at < std::min(Size(), i + kReach + 1); ++at)
      spike_[static_cast<std::size_t>(at)] = SpikeOf(at);
  }
  double Value(long i) const { return value_[static_cast<std::size_t>(i)]; }

 private:
  template <typename Do>
  void ForNeighbours(long i, Do with) const {
    const long before = i - begin_[static_cast<std::size_t>(i)], behind = end_[static_cast<std::size_t>(i)] - 1 - i;
    const long nearest = std::min(before, behind), sense = before <= behind ? 1 : -1;
    const CubicBetween& by = nearest == 0 ? kCubicFirst : nearest == 1 ? kCubicSecond : kCubicInside;
    for (std::size_t k = 0; k < by.at.size(); ++k) with(i + sense * by.at[k], by.weight[k]);
  }

  /// Off, alike for all if the noise is.
  double SpikeOf(long i) const {
    double squares = 1.0;
    ForNeighbours(i, [&](long, double weight) { squares += weight * weight; });
    return Off(i) / std::sqrt(squares);
  }

  double StepAt(long i) const {
    const long next = i + 1 < end_[static_cast<std::size_t>(i)] ? i + 1 : i - 1;
    return std::abs(std::remainder(At(next).target_rad - At(i).target_rad, units::turn));
  }

  std::vector<Reading*> reading_;
  std::vector<long> begin_, end_;  // of the pass of each
  std::vector<double> value_, spike_;
};

/// @return nothing where they are too many.
std::vector<FarReading> ReplaceFarOf(ProbeCourse& course, const Quantity& column) {
  constexpr double kFar = 8.0, kMost = 0.005;  // scatters; of all readings
  if (course.Size() == 0) return {};
  const double scatter = course.Scatter();
  const std::size_t most = std::max<std::size_t>(2, static_cast<std::size_t>(kMost * static_cast<double>(course.Size())));
  std::vector<std::pair<long, FarReading>> far;
  while (far.size() <= most) {
    long worst = 0;
    for (long i = 1; i < course.Size(); ++i)
      if (std::abs(course.Spike(i)) > std::abs(course.Spike(worst))) worst = i;
    const double times = std::abs(course.Spike(worst)) / scatter;
    if (times < kFar || course.IsOfEveryTurn(worst)) break;
    const Reading& r = course.At(worst);
    far.push_back({worst, {r.reading, column.column, r.target_rad, course.Off(worst), times}});
    course.Replace(worst);
  }
  if (far.size() > most) return {};
  std::vector<FarReading> replaced;
  for (const auto& [at, one] : far) {
    column(course.At(at)) = course.Value(at);
    replaced.push_back(one);
  }
  return replaced;
}

}  // namespace

std::vector<FarReading> ReplaceFar(const std::vector<Quantity>& columns, std::vector<Reading>& readings) {
  std::map<int, std::map<int, std::vector<Reading*>>> passes;
  for (Reading& r : readings)
    if (r.status == ReadingStatus::kOk && std::isfinite(r.target_rad)) passes[r.setup][r.pass].push_back(&r);
  std::vector<FarReading> replaced;
  for (const auto& [setup, by_number] : passes) {
    std::vector<std::vector<Reading*>> of_setup;
    for (const auto& [number, pass] : by_number) of_setup.push_back(pass);
    for (const Quantity& column : columns) {
      ProbeCourse course(of_setup, column);
      std::ranges::copy(ReplaceFarOf(course, column), std::back_inserter(replaced));
    }
  }
  return replaced;
}

}  // namespace twinbench::separate::rotary
