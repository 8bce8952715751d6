#include "twin/benches/circular_motion/estimators/far_radii.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "twin/benches/circular_motion/columns.h"
#include "twin/core/robust_scale.h"
#include "twin/core/units.h"

namespace twinbench::separate::circular {
namespace {

constexpr std::size_t kNeighbours = 4, kFewestOfPass = 20;

struct RadiusAt {
  int reading;
  double angle_rad, radius_m;
};

/// Off the cubic through its nearest neighbours, however they are spaced, and the same alike for all if the noise is.
struct OffCurve {
  double off_m, spike_m;
};

class PassOfRadii {
 public:
  explicit PassOfRadii(std::vector<RadiusAt> radii) : radii_(std::move(radii)) {
    for (std::size_t i = 0; i < Size(); ++i) off_.push_back(OffAt(i));
  }

  std::size_t Size() const { return radii_.size(); }
  const RadiusAt& At(std::size_t i) const { return radii_[i]; }
  const OffCurve& Off(std::size_t i) const { return off_[i]; }

  std::size_t Farthest() const {
    const auto size = [](const OffCurve& o) { return std::abs(o.spike_m); };
    return static_cast<std::size_t>(std::ranges::max_element(off_, {}, size) - off_.begin());
  }

  /// Of all, by the median; no less than a step of what was read.
  double Scatter_m() const {
    constexpr double kLeast_m = 1e-9;
    std::vector<double> spikes_m;
    double step_m = INFINITY;
    for (std::size_t i = 0; i < Size(); ++i) {
      spikes_m.push_back(off_[i].spike_m);
      const double change_m = i > 0 ? std::abs(radii_[i].radius_m - radii_[i - 1].radius_m) : 0.0;
      if (change_m > 1e-3 * kLeast_m) step_m = std::min(step_m, change_m);
    }
    return std::max({RobustDeviation(std::move(spikes_m)), std::isfinite(step_m) ? step_m : 0.0, kLeast_m});
  }

  double Step_rad(std::size_t i) const {
    const std::size_t next = i + 1 < Size() ? i + 1 : i - 1;
    return std::abs(std::remainder(radii_[next].angle_rad - radii_[i].angle_rad, units::turn));
  }

  PassOfRadii Without(std::size_t i) const {
    std::vector<RadiusAt> others = radii_;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    return PassOfRadii(std::move(others));
  }

 private:
  OffCurve OffAt(std::size_t i) const {
    const std::size_t half = kNeighbours / 2, last_first = Size() - kNeighbours - 1;
    const std::size_t first = std::min(i < half ? 0 : i - half, last_first);
    double between_m = 0.0, squares = 1.0;
    for (std::size_t k = first; k <= first + kNeighbours; ++k) {
      if (k == i) continue;
      double weight = 1.0;
      for (std::size_t other = first; other <= first + kNeighbours; ++other) {
        if (other != i && other != k)
          weight *= (radii_[i].angle_rad - radii_[other].angle_rad) / (radii_[k].angle_rad - radii_[other].angle_rad);
      }
      between_m += weight * radii_[k].radius_m;
      squares += weight * weight;
    }
    const double off_m = radii_[i].radius_m - between_m;
    if (!std::isfinite(off_m)) return {0.0, 0.0};  // two at one angle
    return {off_m, off_m / std::sqrt(squares)};
  }

  std::vector<RadiusAt> radii_;
  std::vector<OffCurve> off_;
};

constexpr double kAlike = 0.3;  // of a spike

/// A step leaves as much at the next reading when one is taken out.
bool NeighboursAgree(const PassOfRadii& without, std::size_t i, double spike_m) {
  const std::size_t end = std::min(i + 2, without.Size());
  for (std::size_t k = i < 2 ? 0 : i - 2; k < end; ++k)
    if (std::abs(without.Off(k).spike_m) > kAlike * std::abs(spike_m)) return false;
  return true;
}

using PassesThatWay = std::vector<const PassOfRadii*>;

/// Whether another turn shows there what this one does, or there is none and the axis may do so.
bool IsOfTheMachine(const PassesThatWay& that_way, const PassOfRadii& pass, std::size_t i) {
  constexpr double kNear = 1.5, kBehindReversal = 5.0;  // steps
  const RadiusAt& at = pass.At(i);
  bool is_read_again = false;
  for (const PassOfRadii* other : that_way) {
    for (std::size_t k = 0; k < other->Size(); ++k) {
      const RadiusAt& again = other->At(k);
      const bool is_near = std::abs(std::remainder(again.angle_rad - at.angle_rad, units::turn)) <= kNear * pass.Step_rad(i);
      if (!is_near || std::abs(again.reading - at.reading) <= 2) continue;
      if (std::abs(other->Off(k).spike_m) > kAlike * std::abs(pass.Off(i).spike_m)) return true;
      is_read_again = true;
    }
  }
  return !is_read_again && std::abs(std::remainder(at.angle_rad, 0.5 * units::kPi)) < kBehindReversal * pass.Step_rad(i);
}

/// @return nothing where they are too many.
std::vector<FarRadius> FarOf(PassOfRadii pass, const PassesThatWay& that_way) {
  constexpr double kFar = 8.0, kMost = 0.005;  // scatters; of all readings
  const double scatter_m = pass.Scatter_m();
  const std::size_t most = std::max<std::size_t>(2, static_cast<std::size_t>(kMost * static_cast<double>(pass.Size())));
  std::vector<FarRadius> far;
  while (pass.Size() >= kFewestOfPass) {
    const std::size_t worst = pass.Farthest();
    const OffCurve off = pass.Off(worst);
    PassOfRadii without = pass.Without(worst);
    if (std::abs(off.spike_m) < kFar * scatter_m || !NeighboursAgree(without, worst, off.spike_m) || IsOfTheMachine(that_way, pass, worst)) break;
    if (far.size() == most) return {};
    const RadiusAt& at = pass.At(worst);
    far.push_back({at.reading, at.angle_rad, off.off_m, std::abs(off.spike_m) / scatter_m});
    pass = std::move(without);
  }
  return far;
}

}  // namespace

std::vector<FarRadius> TakeOutFar(std::vector<Reading>& readings) {
  std::map<std::array<int, 3>, std::vector<RadiusAt>> by_pass;  // set-up, direction, pass
  for (const Reading& r : readings) {
    const double radius_m = benches::circular::DeviationOf(r).radial_m;
    if (r.status == ReadingStatus::kOk && std::isfinite(radius_m)) by_pass[{r.setup, r.direction, r.pass}].push_back({r.reading, r.target_rad, radius_m});
  }
  std::map<std::pair<int, int>, std::vector<PassOfRadii>> that_way;
  for (auto& [of, radii] : by_pass)
    if (radii.size() >= kFewestOfPass) that_way[{of[0], of[1]}].emplace_back(std::move(radii));
  std::vector<FarRadius> far;
  for (const auto& [way, passes] : that_way) {
    PassesThatWay all;
    for (const PassOfRadii& pass : passes) all.push_back(&pass);
    for (const PassOfRadii& pass : passes) std::ranges::copy(FarOf(pass, all), std::back_inserter(far));
  }
  std::set<int> numbers;
  for (const FarRadius& one : far) numbers.insert(one.reading);
  std::erase_if(readings, [&](const Reading& r) { return numbers.contains(r.reading); });
  return far;
}

}  // namespace twinbench::separate::circular
