#include "twin/diagnose/engine/noise_causes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "twin/core/distributions.h"
#include "twin/core/robust_scale.h"
#include "twin/diagnose/tuning.h"

namespace twinbench::diagnose {
namespace {

constexpr double kLeastLogBayes = 1.0;
constexpr double kLeastRedundancy = 0.05;  // rows below it say nothing about their own noise

/// What is left of each row in units of its own expected scatter, and the rows that can be judged.
struct Standardised {
  Eigen::VectorXd z;
  Eigen::VectorXd kept;  // share of each row's own value that is left of it
  std::vector<int> rows;
  double scale = 1.0;  // robust scatter of z before it was divided out
};

Standardised Standardise(const Rest& rest) {
  Standardised s;
  s.z = Eigen::VectorXd::Zero(rest.rows.size());
  s.kept = rest.redundancy;
  std::vector<double> sure;
  for (Eigen::Index k = 0; k < rest.rows.size(); ++k) {
    if (rest.redundancy[k] < kLeastRedundancy) continue;
    s.z[k] = rest.rows[k] / std::sqrt(rest.redundancy[k]);
    s.rows.push_back(static_cast<int>(k));
    sure.push_back(s.z[k]);
  }
  if (sure.empty()) return s;
  s.scale = std::max(RobustDeviation(std::move(sure)), 1e-12);
  s.z /= s.scale;
  return s;
}

template <typename Density>
double SumOver(const Standardised& s, const Density& density) {
  double sum = 0.0;
  for (const int row : s.rows) sum += density(s.z[row]);
  return sum;
}

double RmsOf(const Standardised& s) {
  return std::sqrt(SumOver(s, [](double z) { return z * z; }) /
                   static_cast<double>(std::max<std::size_t>(1, s.rows.size())));
}

double NormalLikelihood(const Standardised& s) {
  const double w = RmsOf(s);
  return SumOver(s, [w](double z) { return NormalLogDensity(z, w); });
}

struct StudentFit {
  double nu = 0.0, width = 1.0, log_likelihood = -1e300;
};

/// Sum of log(1 + share z^2): one logarithm for several rows. No row is so far off that their product is infinite.
double SumOfLogs(const Standardised& s, double share) {
  constexpr std::size_t kAtOnce = 8;
  constexpr double kMost = 1e36;
  double sum = 0.0;
  for (std::size_t k = 0; k < s.rows.size();) {
    double product = 1.0;
    for (const std::size_t end = std::min(k + kAtOnce, s.rows.size()); k < end; ++k)
      product *= std::min(1.0 + share * s.z[s.rows[k]] * s.z[s.rows[k]], kMost);
    sum += std::log(product);
  }
  return sum;
}

StudentFit FitStudent(const Standardised& s) {
  StudentFit best;
  for (const double nu : {2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 11.0, 15.0, 22.0}) {
    for (double width = 0.6; width < 1.3; width += 0.05) {
      const double l = static_cast<double>(s.rows.size()) * StudentLogDensity(0.0, nu, width) -
                       0.5 * (nu + 1.0) * SumOfLogs(s, 1.0 / (nu * width * width));
      if (l > best.log_likelihood) best = {nu, width, l};
    }
  }
  return best;
}

/// Each row's deviation grows with its own distance, as the scale mixture behind Student's t would have it.
NoiseCause Tails(const NoiseModel& noise, const Standardised& s) {
  const StudentFit fit = FitStudent(s);
  NoiseCause cause{NoiseCause::Kind::kTails,
                   fit.log_likelihood - NormalLikelihood(s) - std::log(10.0 * 14.0),
                   fmt::format("tails like Student's t with {:.3g} degrees of freedom", fit.nu),
                   noise,
                   {},
                   0.0};
  for (const int row : s.rows) {
    const double z2 = std::pow(s.z[row] / fit.width, 2);
    cause.repaired.sigma[row] *= std::sqrt(std::max(1.0, (fit.nu + z2) / (fit.nu + 1.0)));
  }
  return cause;
}

double Farthest(const Standardised& s) {
  double farthest = 0.0;
  for (const int row : s.rows) farthest = std::max(farthest, std::abs(s.z[row]));
  return farthest;
}

/// What single disturbed rows in otherwise normal noise make of the data: each pays for being chosen, and for a
/// size that may be anything up to the largest.
/// @param rest  Without those rows, in the same scale.
double LikelihoodWithout(std::size_t left_out, const Standardised& rest, const Standardised& s) {
  const auto count = static_cast<double>(left_out), all = static_cast<double>(s.rows.size());
  const double chosen =
      LogGamma(all + 1) - LogGamma(count + 1) - LogGamma(all - count + 1) + std::log1p(count);
  return NormalLikelihood(rest) - count * std::log(2.0 * std::max(1.0, Farthest(s))) - chosen;
}

/// Merely heavy-tailed noise has far values, too: then they are no exceptions.
bool AreExceptions(double likelihood_without, const Standardised& s) {
  const double tails = FitStudent(s).log_likelihood - std::log(10.0 * 14.0);
  return likelihood_without > tails + tuning::kExceptional;
}

/// In units of another one's scale.
Standardised InScaleOf(const Standardised& other, Standardised s) {
  s.z *= s.scale / other.scale;
  s.scale = other.scale;
  return s;
}

/// Rows that are far outside what the others leave, and what these leave then.
struct Snooped {
  std::vector<int> far;
  std::vector<double> size;  // of each, in units of noise
  Standardised rest;
};

/// From where on each row is far off; one that was rounded the other way is not.
Eigen::VectorXd FarFrom(const LinearRun& run, const NoiseModel& noise, double scale) {
  constexpr double kBeyondRounding = 1.1;
  return (kBeyondRounding * run.rounding / scale * noise.sigma.cwiseInverse()).cwiseMax(tuning::kFarOff);
}

Snooped Snoop(const Standardised& s, const Eigen::VectorXd& far_from, const RestWithout& without) {
  constexpr double kAtOnce = 0.5;  // of the farthest: what lies nearer may be bent by it
  const double most = tuning::kMostOutlying * static_cast<double>(s.rows.size());
  Snooped found{{}, {}, s};
  for (;;) {
    const std::size_t before = found.far.size();
    const double farthest = Farthest(found.rest);
    for (const int row : found.rest.rows) {
      if (std::abs(found.rest.z[row]) <= std::max(far_from[row], kAtOnce * farthest)) continue;
      found.far.push_back(row);
      found.size.push_back(std::abs(found.rest.z[row]) * s.scale / std::sqrt(found.rest.kept[row]));
    }
    if (static_cast<double>(found.far.size()) > most) return {{}, {}, s};
    if (found.far.size() == before) return found;
    found.rest = InScaleOf(s, Standardise(without(found.far)));
  }
}

/// Of each disturbed reading the largest.
double RmsByReading(const Snooped& found, int channels) {
  std::map<int, double> largest;
  for (std::size_t k = 0; k < found.far.size(); ++k) {
    double& of_reading = largest[found.far[k] / channels];
    of_reading = std::max(of_reading, found.size[k]);
  }
  double sum2 = 0.0;
  for (const auto& [reading, size] : largest) sum2 += size * size;
  return std::sqrt(sum2 / static_cast<double>(largest.size()));
}

/// All rows about what the others leave: each far one as it then stands.
Standardised AboutTheRest(const Snooped& found, const Standardised& s) {
  Standardised all = found.rest;
  all.rows = s.rows;
  for (std::size_t k = 0; k < found.far.size(); ++k) all.z[found.far[k]] = found.size[k] / s.scale;
  return all;
}

/// A few rows far outside while the rest is normal.
NoiseCause Outliers(const LinearRun& run, const NoiseModel& noise, const Standardised& s,
                    const RestWithout& without) {
  NoiseCause cause{NoiseCause::Kind::kOutliers, -1e300, "", noise, {}, 0.0};
  const Snooped found = Snoop(s, FarFrom(run, noise, s.scale), without);
  if (found.far.empty()) return cause;
  const std::size_t count = found.far.size();
  const Standardised all = AboutTheRest(found, s);
  const double mixture = LikelihoodWithout(count, found.rest, all);
  if (AreExceptions(mixture, all)) cause.log_bayes = mixture - NormalLikelihood(s);
  cause.outliers = found.far;
  std::ranges::sort(cause.outliers);
  cause.outlier_size = RmsByReading(found, run.Channels());
  cause.words = fmt::format("{} value{} far outside the noise, left out", count, count == 1 ? "" : "s");
  for (const int row : cause.outliers) cause.repaired.sigma[row] *= 1e4;
  return cause;
}

/// Correlation along each pass. The expected products are taken from the redundancies, which are a lower bound.
NoiseCause Correlation(const LinearRun& run, const NoiseModel& noise, const Standardised& s) {
  constexpr std::size_t kMostApart = 8;
  const FittedAutoregression found = FitAutoregression(s.z, RowsBefore(run, kMostApart), run.Channels());
  NoiseCause cause{NoiseCause::Kind::kCorrelation,
                   found.log_bayes,
                   fmt::format("neighbouring readings are correlated by {:.2f}", found.series.Correlation()),
                   noise,
                   {},
                   0.0};
  cause.repaired.memory = InOne(noise.memory, found.series);
  return cause;
}

NoiseCause ChannelScale(const LinearRun& run, const NoiseModel& noise, const Standardised& s) {
  const int channels = run.Channels();
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(channels), count = squares;
  for (const int row : s.rows) {
    squares[run.ChannelOf(row)] += s.z[row] * s.z[row];
    count[run.ChannelOf(row)] += 1.0;
  }
  const double all2 = squares.sum() / std::max(1.0, count.sum());
  NoiseCause cause{NoiseCause::Kind::kChannelScale,
                   -0.5 * (channels - 1) * std::log(std::max(1.0, count.sum())),
                   "",
                   noise,
                   {},
                   0.0};
  for (int c = 0; c < channels; ++c) {
    const double own2 = squares[c] / std::max(1.0, count[c]);
    if (!(own2 > 0.0)) continue;
    cause.log_bayes -= 0.5 * count[c] * std::log(own2 / all2);
    cause.words += fmt::format("{}{} {:.2f}", c == 0 ? "noise against the mean of all channels: " : ", ",
                               run.channels[static_cast<std::size_t>(c)], std::sqrt(own2 / all2));
    for (int row = c; row < run.Rows(); row += channels) cause.repaired.sigma[row] *= std::sqrt(own2 / all2);
  }
  return cause;
}

}  // namespace

std::vector<NoiseCause> FindNoiseCauses(const LinearRun& run, const NoiseModel& noise, const Rest& rest,
                                        const RestWithout& without) {
  const Standardised s = Standardise(rest);
  if (s.rows.empty() || run.noise_free) return {};
  std::vector<NoiseCause> causes = {Outliers(run, noise, s, without), Tails(noise, s), Correlation(run, noise, s)};
  if (run.Channels() > 1) causes.push_back(ChannelScale(run, noise, s));
  std::erase_if(causes, [](const NoiseCause& cause) { return !(cause.log_bayes > kLeastLogBayes); });
  std::ranges::stable_sort(causes, std::greater<>(), &NoiseCause::log_bayes);
  return causes;
}

}  // namespace twinbench::diagnose
