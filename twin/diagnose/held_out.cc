#include "twin/diagnose/held_out.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "twin/core/errors.h"
#include "twin/core/stream.h"
#include "twin/diagnose/tuning.h"

namespace twinbench::diagnose {
namespace {

constexpr int kDraws = 1000;
constexpr double kFewestPairs = 20.0;  // neighbours; fewer do not tell the noise

/// The noise variance in units of the stated one.
double NoiseScale(const HeldOutSums& sum, bool is_stated, double correlation) {
  if (is_stated || sum.pairs < kFewestPairs) return 1.0;
  return sum.steps / sum.pairs / (1.0 - correlation);
}

struct Shares {
  double removed = 0.0, remaining = 0.0;

  double Plain() const { return removed / std::max(removed + remaining, 0.0); }
  double Fraction() const {
    if (!(removed > 0.0))
      return removed + remaining > 0.0 ? Plain() : 0.0;  // 0: nothing to remove, nothing removed
    const double q = remaining / removed;
    return q > 0.0 ? 1.0 / (1.0 + q) : 1.0 - q;
  }
};

Shares SharesOf(const HeldOutSums& sum, double scale) {
  constexpr double kRounding = 1e-9;  // of what was there: nothing was removed
  const double removed = sum.before - sum.after;
  return {std::abs(removed) > kRounding * sum.before ? removed : 0.0, sum.after - scale * sum.floor};
}

double Quantile(const std::vector<double>& sorted, double q) {
  return sorted[static_cast<std::size_t>(q * static_cast<double>(sorted.size() - 1) + 0.5)];
}

HeldOutSums Drawn(const std::vector<HeldOutSums>& blocks, Stream& stream) {
  HeldOutSums sum;
  for (std::size_t b = 0; b < blocks.size(); ++b)
    sum += blocks[static_cast<std::size_t>(stream.Uniform() * static_cast<double>(blocks.size()))];
  return sum;
}

/// The mean of the middle 95 %: single draws in which next to nothing was removed must not decide it.
double MeanWithin(const std::vector<double>& sorted, const std::array<double, 2>& interval) {
  double sum = 0.0, count = 0.0;
  for (const double v : sorted) {
    if (v < interval[0] || v > interval[1]) continue;
    sum += v;
    count += 1.0;
  }
  return sum / count;
}

double Deviation(const std::vector<double>& values) {
  const Eigen::Map<const Eigen::ArrayXd> v(values.data(), std::ssize(values));
  return std::sqrt((v - v.mean()).square().mean());
}

/// What is expected of a power that no size's uncertainty explains: nothing, or anything.
/// @param seen  It, with a deviation of `sd`.
double ExpectedUnmodelled(double seen, double sd) {
  constexpr int kSteps = 400;
  constexpr double kLeast = 1.0, kFarOff = 5.0;  // of the noise of a reading; in deviations
  const double most = seen + kFarOff * sd;
  if (!(sd > 0.0) || !(most > kLeast)) return std::max(seen, 0.0);
  const auto likelihood = [&](double power) { return std::exp(-0.5 * std::pow((seen - power) / sd, 2)); };
  double any = 0.0, mean = 0.0;
  for (int k = 0; k < kSteps; ++k) {
    const double power = kLeast * std::pow(most / kLeast, (k + 0.5) / kSteps);
    const double weight = likelihood(power) / kSteps;
    any += weight;
    mean += weight * power;
  }
  const double all = tuning::kListed * likelihood(0.0) + (1.0 - tuning::kListed) * any;
  return all > 0.0 ? (1.0 - tuning::kListed) * mean / all : std::max(seen, 0.0);
}

/// @param sd  Of what remains.
double OnAnotherRun(const HeldOutSums& sum, const Shares& shares, double scale, double sd) {
  const double sizes = scale * sum.fold_sizes;
  const double unmodelled = ExpectedUnmodelled(shares.remaining - sizes, sd);
  const double removable = shares.removed + unmodelled + sizes;
  return 1.0 - (unmodelled + scale * sum.all_sizes) / removable;
}

}  // namespace

HeldOutSums& HeldOutSums::operator+=(const HeldOutSums& other) {
  before += other.before;
  after += other.after;
  floor += other.floor;
  fold_sizes += other.fold_sizes;
  all_sizes += other.all_sizes;
  weight += other.weight;
  steps += other.steps;
  pairs += other.pairs;
  return *this;
}

void FillGain(const std::vector<HeldOutSums>& blocks, bool noise_is_stated, double correlation, Gain& gain) {
  HeldOutSums all;
  for (const HeldOutSums& block : blocks) all += block;
  const auto shares_of = [&](const HeldOutSums& sum) {
    return SharesOf(sum, NoiseScale(sum, noise_is_stated, correlation));
  };
  Stream stream(1, "diagnose.gain");
  std::vector<double> fractions, removed, remaining;
  for (int draw = 0; draw < kDraws; ++draw) {
    const Shares shares = shares_of(Drawn(blocks, stream));
    removed.push_back(shares.removed);
    remaining.push_back(shares.remaining);
    fractions.push_back(shares.Fraction());
  }
  std::ranges::sort(fractions);
  std::ranges::sort(removed);
  gain.before_m = std::sqrt(all.before / all.weight);
  gain.after_m = std::sqrt(all.after / all.weight);
  gain.noise_floor_m = std::sqrt(NoiseScale(all, noise_is_stated, correlation) * all.floor / all.weight);
  gain.interval95 = {Quantile(fractions, 0.025), Quantile(fractions, 0.975)};
  gain.positive = Quantile(removed, 0.025) > 0.0;
  const Shares shares = shares_of(all);
  gain.fraction_removed =
      gain.positive ? 2.0 * shares.Fraction() - MeanWithin(fractions, gain.interval95) : shares.Plain();
  if (!std::isfinite(gain.fraction_removed)) gain.fraction_removed = kNaN;
  gain.another_run = gain.fraction_removed;
  if (gain.positive)
    gain.another_run =
        OnAnotherRun(all, shares, NoiseScale(all, noise_is_stated, correlation), Deviation(remaining));
}

}  // namespace twinbench::diagnose
