#include "twin/import/follows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "twin/core/lag.h"
#include "twin/core/units.h"
#include "twin/import/common.h"
#include "twin/import/course.h"

namespace twinbench::imports {
namespace {

struct KnownRatio {
  double ratio;
  const char* meaning;
};

constexpr std::array kRatios = std::to_array<KnownRatio>({
    {180.0 / units::kPi, "one of the two is in rad, the other in deg"},
    {3600.0, "one of the two is in arcsec, the other in deg"},
    {60.0, "one of the two is in arcmin, the other in deg"},
    {360.0, "one of the two is in turns, the other in deg"},
    {2.0 * units::kPi, "one of the two is in turns, the other in rad"},
    {206264.806, "one of the two is in arcsec, the other in rad"},
    {1000.0, "one of the two is in thousandths (mm and um, rad and mrad, deg and mdeg)"},
    {1e6, "one of the two is in millionths (m and um, rad and urad)"},
    {10.0 / 9.0, "one of the two is in gon, the other in deg"},
    {25.4, "one of the two is in inches, the other in mm"},
});

double SizeOf(double gain) {
  return std::max(std::abs(gain), 1.0 / std::abs(gain));
}

/// null: it is none.
const KnownRatio* KnownRatioOf(double gain) {
  const auto known = std::ranges::find_if(kRatios, [gain](const KnownRatio& k) { return std::abs(SizeOf(gain) / k.ratio - 1.0) < 0.02; });
  return known == kRatios.end() ? nullptr : &*known;
}

constexpr double kLine = 0.995;  // correlation: what is left of a line is a tenth of the way at most

/// Two places alone lie on a line whatever the device does.
bool HasThreePlaces(std::span<const double> x) {
  const auto second = std::ranges::find_if(x, [&x](double one) { return one != x.front(); });
  return std::any_of(second, x.end(), [&](double one) { return one != x.front() && one != *second; });
}

Following LeastSquares(std::span<const double> x, std::span<const double> y) {
  const StraightLine line = LineThrough(x, y);
  return {line.slope, line.correlation, 0, std::abs(line.correlation) > kLine && HasThreePlaces(x)};
}

/// The rows just before a command that waits goes on: a servo is on its way in the others.
std::vector<std::size_t> Arrivals(const std::vector<double>& command) {
  std::vector<std::size_t> rows;
  for (std::size_t i = 1; i + 1 < command.size(); ++i) {
    if (command[i] == command[i - 1] && command[i] != command[i + 1]) rows.push_back(i);
  }
  return rows;
}

Following AtArrivals(const std::vector<double>& reference, const std::vector<double>& shown) {
  std::vector<double> x, y;
  for (const std::size_t row : Arrivals(reference)) {
    x.push_back(reference[row]);
    y.push_back(shown[row]);
  }
  constexpr std::size_t kFewest = 4;
  constexpr double kLeastShare = 0.5;  // of the way: rests beside each other say nothing of the whole
  if (x.size() < kFewest) return {};
  const auto [low, high] = std::ranges::minmax(reference);
  const auto [lowest, highest] = std::ranges::minmax(x);
  return highest - lowest < kLeastShare * (high - low) ? Following{} : LeastSquares(x, y);
}

/// From row to row, whole turns aside: of two columns that have nothing to do with each other half of the steps are
/// longer than a quarter of a turn, and unwrapping them would find a course in chance. Neither may be so while it moves, if it mostly rests.
bool GoesSmoothly(const std::vector<double>& angle) {
  std::vector<double> sizes;
  for (const double step : StepsOf(angle)) sizes.push_back(std::abs(std::remainder(step, units::turn)));
  constexpr double kNearlyAll = 0.9;
  return QuantileOf(sizes, kNearlyAll) < units::turn / 4.0 && MedianOf(std::move(sizes)) < units::turn / 12.0;
}

/// The one that goes more closely together; of two that do the one nearer to one to one.
Following Better(const Following& a, const Following& b) {
  constexpr double kAlike = 0.001;
  if (std::abs(std::abs(a.correlation) - std::abs(b.correlation)) < kAlike)
    return std::abs(b.gain - 1.0) < std::abs(a.gain - 1.0) ? b : a;
  return std::abs(b.correlation) > std::abs(a.correlation) ? b : a;
}

}  // namespace

Following FollowingOf(const std::vector<double>& reference, const std::vector<double>& shown) {
  Following best = Better(LeastSquares(reference, shown), AtArrivals(reference, shown));
  std::vector<double> unwrapped = shown;
  if (GoesSmoothly(shown) && Unwrap(units::turn, unwrapped) > 0) {
    best = Better(best, LeastSquares(reference, unwrapped));
    best = Better(best, AtArrivals(reference, unwrapped));
  }
  // The difference of the two may be followed where neither can be: large steps, both going round.
  std::vector<double> difference;
  for (std::size_t i = 0; i < shown.size(); ++i) difference.push_back(shown[i] - reference[i]);
  if (!GoesSmoothly(difference)) return best;
  Unwrap(units::turn, difference);
  for (std::size_t i = 0; i < shown.size(); ++i) difference[i] += reference[i];
  const Following other = LeastSquares(reference, difference);
  return std::abs(other.gain - 1.0) < 0.2 ? Better(best, other) : best;
}

Following FollowingLater(const std::vector<double>& reference, const std::vector<double>& shown) {
  std::vector<double> device = shown;
  if (GoesSmoothly(shown)) Unwrap(units::turn, device);
  const auto lag = LagOf(reference, device);
  if (!lag) return {};
  Following following = LeastSquares(std::span(reference).first(reference.size() - *lag), std::span(device).subspan(*lag));
  following.rows_later = *lag;
  return following;
}

std::string MeaningOfGain(double gain) {
  if (const KnownRatio* known = KnownRatioOf(gain)) return known->meaning;
  return std::abs(SizeOf(gain) - 1.0) < 0.2 && gain < 0.0 ? "they count in opposite directions" : "";
}

double NominalGain(double gain) {
  const KnownRatio* known = KnownRatioOf(gain);
  return known ? std::copysign(std::abs(gain) >= 1.0 ? known->ratio : 1.0 / known->ratio, gain) : gain;
}

}  // namespace twinbench::imports
