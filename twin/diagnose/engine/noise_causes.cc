#include "twin/diagnose/engine/noise_causes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "twin/core/distributions.h"
#include "twin/diagnose/tuning.h"

namespace twinbench::diagnose {
namespace {

constexpr double kLeastLogBayes = 1.0;
constexpr double kLeastRedundancy = 0.05;  // rows below it say nothing about their own noise

/// What is left of each row in units of its own expected scatter, and the rows that can be judged.
struct Standardised {
  Eigen::VectorXd z;
  std::vector<int> rows;
  double scale = 1.0;  // robust scatter of z before it was divided out
};

Standardised Standardise(const Eigen::VectorXd& rows, const Eigen::VectorXd& redundancy) {
  Standardised s;
  s.z = Eigen::VectorXd::Zero(rows.size());
  std::vector<double> sizes;
  for (Eigen::Index k = 0; k < rows.size(); ++k) {
    if (redundancy[k] < kLeastRedundancy) continue;
    s.z[k] = rows[k] / std::sqrt(redundancy[k]);
    s.rows.push_back(static_cast<int>(k));
    sizes.push_back(std::abs(s.z[k]));
  }
  if (sizes.empty()) return s;
  s.scale = std::max(Median(sizes) / 0.6745, 1e-12);
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

StudentFit FitStudent(const Standardised& s) {
  StudentFit best;
  for (const double nu : {2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 11.0, 15.0, 22.0}) {
    for (double width = 0.6; width < 1.3; width += 0.05) {
      const double l = SumOver(s, [=](double z) { return StudentLogDensity(z, nu, width); });
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

/// What single disturbed rows in otherwise normal noise make of the data: each pays for being chosen, and for a
/// size that may be anything up to the largest.
double LikelihoodWithout(const std::vector<int>& far, const Standardised& s) {
  Standardised rest = s;
  std::erase_if(rest.rows, [&](int row) { return std::ranges::find(far, row) != far.end(); });
  double top = 1.0;
  for (const int row : s.rows) top = std::max(top, std::abs(s.z[row]));
  const auto count = static_cast<double>(far.size()), all = static_cast<double>(s.rows.size());
  const double chosen =
      std::lgamma(all + 1) - std::lgamma(count + 1) - std::lgamma(all - count + 1) + std::log1p(count);
  return NormalLikelihood(rest) - count * std::log(2.0 * top) - chosen;
}

/// Merely heavy-tailed noise has far values, too: then they are no exceptions.
bool AreExceptions(double likelihood_without, const Standardised& s) {
  const double tails = FitStudent(s).log_likelihood - std::log(10.0 * 14.0);
  return likelihood_without > tails + tuning::kExceptional;
}

/// A few rows far outside while the rest is normal.
NoiseCause Outliers(const LinearRun& run, const NoiseModel& noise, const Standardised& s) {
  constexpr double kBeyondRounding = 1.1;  // a value that was rounded the other way is no exception
  NoiseCause cause{NoiseCause::Kind::kOutliers, -1e300, "", noise, {}, 0.0};
  for (const int row : s.rows) {
    const double size = std::abs(s.z[row]);
    if (size > tuning::kFarOff && size * s.scale * noise.sigma[row] > kBeyondRounding * run.rounding)
      cause.outliers.push_back(row);
  }
  const auto count = static_cast<double>(cause.outliers.size()), all = static_cast<double>(s.rows.size());
  if (count == 0.0 || count > tuning::kMostOutlying * all) return cause;
  double sum2 = 0.0;
  for (const int row : cause.outliers) sum2 += s.z[row] * s.z[row];
  cause.outlier_size = std::sqrt(sum2 / count);
  const double mixture = LikelihoodWithout(cause.outliers, s);
  if (AreExceptions(mixture, s)) cause.log_bayes = mixture - NormalLikelihood(s);
  cause.words =
      fmt::format("{} value{} far outside the noise, left out", cause.outliers.size(), count == 1.0 ? "" : "s");
  for (const int row : cause.outliers) cause.repaired.sigma[row] *= 1e4;
  return cause;
}

bool SamePass(const Schedule& s, std::size_t i) {
  return s.setup[i] == s.setup[i - 1] && s.pass[i] == s.pass[i - 1] && s.phase[i] == s.phase[i - 1];
}

/// First-order correlation along each pass. Projection makes white residuals look anticorrelated; the expected
/// product is taken from the redundancies (a lower bound), so only a positive excess counts.
NoiseCause Correlation(const LinearRun& run, const NoiseModel& noise, const Standardised& s) {
  const int channels = run.Channels();
  double products = 0.0, squares = 0.0;
  int pairs = 0;
  for (int k = channels; k < run.Rows(); ++k) {
    if (!SamePass(run.schedule, static_cast<std::size_t>(run.ReadingOf(k)))) continue;
    const double a = std::clamp(s.z[k], -4.0, 4.0), b = std::clamp(s.z[k - channels], -4.0, 4.0);
    products += a * b;
    squares += 0.5 * (a * a + b * b);
    ++pairs;
  }
  const double rho = squares > 0.0 ? std::clamp(products / squares, 0.0, 0.95) : 0.0;
  NoiseCause cause{NoiseCause::Kind::kCorrelation,
                   -0.5 * pairs * std::log1p(-rho * rho) - 0.5 * std::log(std::max(1, pairs)),
                   fmt::format("neighbouring readings are correlated by {:.2f}", rho),
                   noise,
                   {},
                   0.0};
  cause.repaired.rho = 1.0 - (1.0 - noise.rho) * (1.0 - rho);
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

bool StandOut(const std::vector<int>& far, const Eigen::VectorXd& z) {
  Standardised s;
  s.z = z;
  for (int row = 0; row < z.size(); ++row) {
    if (z[row] != 0.0) s.rows.push_back(row);
  }
  return AreExceptions(LikelihoodWithout(far, s), s);
}

std::vector<NoiseCause> FindNoiseCauses(const LinearRun& run, const NoiseModel& noise, const Eigen::VectorXd& rows,
                                        const Eigen::VectorXd& redundancy) {
  const Standardised s = Standardise(rows, redundancy);
  if (s.rows.empty() || run.noise_free) return {};
  std::vector<NoiseCause> causes = {Outliers(run, noise, s), Tails(noise, s), Correlation(run, noise, s)};
  if (run.Channels() > 1) causes.push_back(ChannelScale(run, noise, s));
  std::erase_if(causes, [](const NoiseCause& cause) { return !(cause.log_bayes > kLeastLogBayes); });
  std::ranges::stable_sort(causes, std::greater<>(), &NoiseCause::log_bayes);
  return causes;
}

}  // namespace twinbench::diagnose
