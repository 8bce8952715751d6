#include "twin/plan/shift_sets.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "twin/core/errors.h"
#include "twin/core/stream.h"
#include "twin/core/units.h"

namespace twinbench::plan {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kLost = 1e-9;     // of the determinant, in units of m^2
constexpr double kMostSets = 4e6;  // that are all looked at

using Phasors = std::vector<std::complex<double>>;

/// exp(2 pi i j / n)
Phasors PhasorsOf(int n) {
  Phasors phasors;
  for (int j = 0; j < n; ++j) phasors.push_back(std::polar(1.0, 2.0 * units::kPi * j / n));
  return phasors;
}

double FactorOf(double m, double sum2) {
  const double share = 1.0 - sum2 / (m * m);
  return share > kLost ? 1.0 / share : kInfinite;
}

/// Sums over the shifts that stay, harmonic by harmonic, so that trying one more costs one addition each.
class Sums {
 public:
  explicit Sums(int n) : n_(n), phasors_(PhasorsOf(n)), sums_(static_cast<std::size_t>(n / 2)) {}

  void Add(int shift, double sign = 1.0) {
    count_ += sign;
    for (int k = 1; k <= n_ / 2; ++k) sums_[Index(k)] += sign * Phasor(k, shift);
  }

  /// Of the harmonics, with one more shift. A lost one counts so much that the fewest are lost first.
  double MeanWith(int shift) const {
    constexpr double kLostWeight = 1e6;
    double sum = 0.0;
    for (int k = 1; k <= n_ / 2; ++k) {
      const double factor = FactorOf(count_ + 1.0, std::norm(sums_[Index(k)] + Phasor(k, shift)));
      sum += std::isfinite(factor) ? factor : kLostWeight;
    }
    return sum / (n_ / 2);
  }

 private:
  static std::size_t Index(int harmonic) { return static_cast<std::size_t>(harmonic - 1); }
  const std::complex<double>& Phasor(int harmonic, int shift) const {
    return phasors_[static_cast<std::size_t>(static_cast<long long>(harmonic) * shift % n_)];
  }

  int n_;
  Phasors phasors_;
  double count_ = 0.0;
  std::vector<std::complex<double>> sums_;
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
    sums.Add(s, -1.0);
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

Found FromManyStarts(int n, int count) {
  constexpr int kStarts = 24;
  Stream random(1, "plan.shifts");
  Found best;
  for (int start = 0; start < kStarts; ++start) {
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

double VarianceFactor(int positions, const std::vector<int>& shifts, int harmonic) {
  std::complex<double> sum = 0.0;
  for (const int s : shifts) sum += std::polar(1.0, 2.0 * units::kPi * harmonic * s / positions);
  return FactorOf(static_cast<double>(shifts.size()), std::norm(sum));
}

std::vector<double> VarianceFactors(int positions, const std::vector<int>& shifts) {
  std::vector<double> factors;
  for (int k = 1; k <= positions / 2; ++k) factors.push_back(VarianceFactor(positions, shifts, k));
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
  ShiftSet best;
  for (int s = 0; s < positions; ++s) {
    if (std::ranges::count(shifts, s) > 0) continue;
    std::vector<int> more = shifts;
    more.push_back(s);
    ShiftSet set = Judged(positions, more);
    const auto rank = [](const ShiftSet& one) { return std::pair(one.lost.size(), one.mean_factor); };
    if (best.shifts.empty() || rank(set) < rank(best)) best = std::move(set);
  }
  return best;
}

}  // namespace twinbench::plan
