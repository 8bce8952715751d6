#include "twin/investigate/expected_information.h"

#include <algorithm>
#include <cmath>

#include "twin/core/linear_algebra.h"
#include "twin/core/stream.h"

namespace twinbench::investigate {
namespace {

constexpr int kDraws = 400;

/// log N(y; mean, 1 + spread spread') but for a constant that all share.
class Gaussian {
 public:
  explicit Gaussian(const Expectation& e)
      : mean_(e.mean),
        root_(CholeskyFactorOf(Eigen::MatrixXd::Identity(e.mean.size(), e.mean.size()) + e.spread * e.spread.transpose())),
        half_log_det_(root_.diagonal().array().log().sum()) {}

  Eigen::VectorXd Draw(Stream& stream) const {
    Eigen::VectorXd normal(mean_.size());
    for (double& value : normal) value = stream.Normal();
    return mean_ + root_.triangularView<Eigen::Lower>() * normal;
  }
  double LogDensity(const Eigen::VectorXd& y) const {
    const Eigen::VectorXd white = root_.triangularView<Eigen::Lower>().solve(y - mean_);
    return -0.5 * white.squaredNorm() - half_log_det_;
  }

 private:
  Eigen::VectorXd mean_;
  Eigen::MatrixXd root_;
  double half_log_det_;
};

/// log sum_j p_j density_j(y).
double LogMixture(const std::vector<Gaussian>& gaussians, const std::vector<Expectation>& expectations,
                  const Eigen::VectorXd& y) {
  Eigen::VectorXd logs(std::ssize(gaussians));
  for (std::size_t j = 0; j < gaussians.size(); ++j)
    logs[static_cast<Eigen::Index>(j)] = std::log(expectations[j].probability) + gaussians[j].LogDensity(y);
  const double most = logs.maxCoeff();
  return most + std::log((logs.array() - most).exp().sum());
}

}  // namespace

double Entropy_bit(const std::vector<double>& probabilities) {
  double entropy = 0.0;
  for (const double p : probabilities) entropy -= p > 0.0 ? p * std::log2(p) : 0.0;
  return entropy;
}

double ExpectedInformation_bit(const std::vector<Expectation>& expectations) {
  std::vector<Expectation> possible;
  std::ranges::copy_if(expectations, std::back_inserter(possible),
                       [](const Expectation& e) { return e.probability > 0.0; });
  std::vector<Gaussian> gaussians;
  std::vector<double> probabilities;
  for (const Expectation& e : possible) {
    gaussians.emplace_back(e);
    probabilities.push_back(e.probability);
  }
  double information = 0.0;
  for (std::size_t i = 0; i < gaussians.size(); ++i) {
    Stream stream(i, "investigate.expected_information");
    double mean = 0.0;
    for (int draw = 0; draw < kDraws; ++draw) {
      const Eigen::VectorXd y = gaussians[i].Draw(stream);
      mean += (gaussians[i].LogDensity(y) - LogMixture(gaussians, possible, y)) / kDraws;
    }
    information += probabilities[i] * mean / std::log(2.0);
  }
  return std::clamp(information, 0.0, Entropy_bit(probabilities));
}

}  // namespace twinbench::investigate
