#include "twin/plan/shift_sets.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numeric>

#include "twin/core/errors.h"
#include "twin/core/stream.h"
#include "twin/core/units.h"
#include "twin/separate/shift_transfer.h"

namespace twinbench::plan {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kMostSets = 4e6;  // that are all looked at

using Phasor = std::complex<double>;
using Phasors = std::vector<Phasor>;

/// exp(2 pi i j / n)
Phasors PhasorsOf(int n) {
  Phasors phasors;
  for (int j = 0; j < n; ++j) phasors.push_back(std::polar(1.0, 2.0 * units::kPi * j / n));
  return phasors;
}

/// Rounding of the difference is 1e-16 of m^2, so that it tells sets apart up to some millions of positions. What is
/// lost is known beforehand, in integers.
double FactorOf(double m, double sum2) {
  return 1.0 / (1.0 - sum2 / (m * m));
}

/// Sums over the shifts that stay, harmonic by harmonic, so that trying one more costs one addition each.
class Sums {
 public:
  explicit Sums(int n) : n_(n), phasors_(PhasorsOf(n)), sums_(static_cast<std::size_t>(n / 2)) {}

  void Add(int shift) {
    shifts_.push_back(shift);
    ForAll(shift, [this](int k, const Phasor& z) { sums_[Index(k)] += z; });
  }
  void TakeLast() {
    ForAll(shifts_.back(), [this](int k, const Phasor& z) { sums_[Index(k)] -= z; });
    shifts_.pop_back();
  }

  /// Of the harmonics, with one more shift. A lost one counts so much that the fewest are lost first: all that two
  /// shifts see add up to n^2 / 6 at the most, if none is lost.
  double MeanWith(int shift) const {
    const double of_lost = static_cast<double>(n_) * n_;
    const double count = static_cast<double>(shifts_.size()) + 1.0;
    const int step = FirstLostWith(shift);
    int lost = step;
    double sum = 0.0;
    ForAll(shift, [&](int k, const Phasor& z) {
      sum += k == lost ? of_lost : FactorOf(count, std::norm(sums_[Index(k)] + z));
      if (k == lost) lost += step;
    });
    return sum / (n_ / 2);
  }

 private:
  static std::size_t Index(int harmonic) { return static_cast<std::size_t>(harmonic - 1); }

  /// Calls visit(k, exp(2 pi i k shift / n)) for all harmonics.
  template <typename Visit>
  void ForAll(int shift, const Visit& visit) const {
    const int by = (shift % n_ + n_) % n_;
    for (int k = 1, at = by; k <= n_ / 2; ++k) {
      visit(k, phasors_[static_cast<std::size_t>(at)]);
      at += by;
      if (at >= n_) at -= n_;
    }
  }

  /// Its multiples are lost (separate::shifts::CommonDivisor).
  int FirstLostWith(int shift) const {
    int common = n_;
    for (const int s : shifts_) common = std::gcd(common, shift - s);
    return n_ / common;
  }

  int n_;
  Phasors phasors_;
  std::vector<int> shifts_;
  Phasors sums_;
};

struct Found {
  std::vector<int> shifts;
  double mean = kInfinite;
};

/// All sets that go on from `shifts` with larger ones.
void Look(int n, int missing, std::vector<int>& shifts, Sums& sums, Found& best) {
  for (int s = shifts.back() + 1; s < n; ++s) {
    if (missing == 1) {
      const double mean = sums.MeanWith(s);
      if (!(mean < best.mean)) continue;
      best = {shifts, mean};
      best.shifts.push_back(s);
      continue;
    }
    shifts.push_back(s);
    sums.Add(s);
    Look(n, missing - 1, shifts, sums, best);
    sums.TakeLast();
    shifts.pop_back();
  }
}

double SetsOf(int n, int count) {
  double sets = 1.0;  // n - 1 over count - 1: 0 is always one
  for (int k = 1; k < count; ++k) sets *= static_cast<double>(n - k) / k;
  return sets;
}

/// Exchanges one shift at a time for the best there is.
Found Exchanged(int n, std::vector<int> shifts) {
  Found best{shifts, kInfinite};
  for (bool better = true; better;) {
    better = false;
    for (std::size_t j = 1; j < shifts.size(); ++j) {
      Sums others(n);
      for (std::size_t i = 0; i < shifts.size(); ++i) {
        if (i != j) others.Add(shifts[i]);
      }
      for (int s = 1; s < n; ++s) {
        if (std::ranges::count(shifts, s) > 0 && s != shifts[j]) continue;
        const double mean = others.MeanWith(s);
        if (!(mean < best.mean * (1.0 - 1e-12))) continue;
        shifts[j] = s;
        best = {shifts, mean};
        better = true;
      }
    }
  }
  return best;
}

/// A start costs some n^2 per shift, several times over.
int StartsFor(int n) {
  constexpr int kMost = 24;
  constexpr double kMostLooked = 1e7;  // sums of one harmonic
  return std::clamp(static_cast<int>(kMostLooked / (static_cast<double>(n) * n)), 1, kMost);
}

Found FromManyStarts(int n, int count) {
  Stream random(1, "plan.shifts");
  Found best;
  for (int start = 0, starts = StartsFor(n); start < starts; ++start) {
    std::vector<int> shifts = {0};
    while (static_cast<int>(shifts.size()) < count) {
      const int s = 1 + static_cast<int>(random.Uniform() * (n - 1));
      if (std::ranges::count(shifts, s) == 0) shifts.push_back(s);
    }
    Found found = Exchanged(n, std::move(shifts));
    if (found.mean < best.mean) best = std::move(found);
  }
  return best;
}

}  // namespace

std::vector<double> VarianceFactors(int positions, const std::vector<int>& shifts) {
  const std::vector<double> alike(shifts.size(), 1.0);
  std::vector<double> factors;
  for (const auto& transfer : separate::shifts::Transfers({positions, shifts, alike})) {
    if (transfer.order > 0) factors.push_back(transfer.VarianceFactor());
  }
  return factors;
}

double LeastPossible(int positions, int count) {
  const double n = positions, m = count;
  const double mean_of_squares = (n * m - m * m) / (positions % 2 == 0 ? n : n - 1.0);
  return 1.0 / (1.0 - mean_of_squares / (m * m));
}

ShiftSet Judged(int positions, const std::vector<int>& shifts) {
  ShiftSet set;
  set.shifts = shifts;
  set.least_possible = LeastPossible(positions, static_cast<int>(shifts.size()));
  const std::vector<double> factors = VarianceFactors(positions, shifts);
  for (std::size_t k = 0; k < factors.size(); ++k) {
    set.mean_factor += factors[k] / static_cast<double>(factors.size());
    set.worst_factor = std::max(set.worst_factor, factors[k]);
    if (!std::isfinite(factors[k])) set.lost.push_back(static_cast<int>(k) + 1);
  }
  return set;
}

ShiftSet BestShifts(int positions, int count) {
  Require(count >= 2 && count <= positions, "there are from 2 to n shifts");
  Found best;
  const bool exhaustive = SetsOf(positions, count) <= kMostSets;
  if (exhaustive) {
    std::vector<int> shifts = {0};
    Sums sums(positions);
    sums.Add(0);
    Look(positions, count - 1, shifts, sums, best);
  } else {
    best = FromManyStarts(positions, count);
  }
  std::ranges::sort(best.shifts);
  ShiftSet set = Judged(positions, best.shifts);
  set.exhaustive = exhaustive;
  return set;
}

ShiftSet WithOneMore(int positions, const std::vector<int>& shifts) {
  Require(std::ssize(shifts) < positions, "there is one more shift");
  Sums sums(positions);
  for (const int s : shifts) sums.Add(s);
  int best = -1;
  double least = kInfinite;
  for (int s = 0; s < positions; ++s) {
    if (std::ranges::count(shifts, s) > 0) continue;
    const double mean = sums.MeanWith(s);
    if (!(mean < least)) continue;
    least = mean;
    best = s;
  }
  std::vector<int> more = shifts;
  more.push_back(best);
  return Judged(positions, more);
}

}  // namespace twinbench::plan
