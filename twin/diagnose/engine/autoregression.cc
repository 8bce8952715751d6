#include "twin/diagnose/engine/autoregression.h"

#include <algorithm>
#include <cmath>

namespace twinbench::diagnose {
namespace {

/// The weights of one value more, from those of the values that are nearer.
std::vector<double> WithOneMore(const std::vector<double>& nearer, double partial) {
  std::vector<double> weights = nearer;
  for (std::size_t j = 0; j < nearer.size(); ++j) weights[j] -= partial * nearer[nearer.size() - 1 - j];
  weights.push_back(partial);
  return weights;
}

std::vector<double> WeightsOf(const Autoregression& series) {
  return ForecastsOf(series).back().weights;
}

/// The way back from weights of a stationary series.
Autoregression FromWeights(std::vector<double> weights) {
  Autoregression series;
  while (!weights.empty()) {
    const double last = weights.back();
    series.partial.push_back(last);
    weights.pop_back();
    const std::vector<double> now = weights;
    for (std::size_t j = 0; j < now.size(); ++j) weights[j] = (now[j] + last * now[now.size() - 1 - j]) / (1.0 - last * last);
  }
  std::ranges::reverse(series.partial);
  return series;
}

/// Products of rows that are `apart` rows apart, and how many there are.
struct Products {
  double sum = 0.0, squares = 0.0;
  int pairs = 0;
};

Products ProductsOf(const Eigen::VectorXd& z, const std::vector<int>& before, int apart, int step) {
  constexpr double kFar = 4.0;
  Products products;
  for (Eigen::Index k = 0; k < z.size(); ++k) {
    if (before[static_cast<std::size_t>(k)] < apart) continue;
    const double a = std::clamp(z[k], -kFar, kFar), b = std::clamp(z[k - apart * step], -kFar, kFar);
    products.sum += a * b;
    products.squares += 0.5 * (a * a + b * b);
    ++products.pairs;
  }
  return products;
}

/// Partial correlations from plain ones (Levinson and Durbin).
std::vector<double> PartialOf(const std::vector<double>& correlations) {
  constexpr double kMostPartial = 0.999;
  std::vector<double> partial, weights;
  double left = 1.0;
  for (std::size_t k = 0; k < correlations.size(); ++k) {
    double more = correlations[k];
    for (std::size_t j = 0; j < weights.size(); ++j) more -= weights[j] * correlations[k - 1 - j];
    if (!(std::abs(more) < kMostPartial * left)) break;  // pairs of several passes need not fit together
    partial.push_back(more / left);
    weights = WithOneMore(weights, partial.back());
    left *= 1.0 - partial.back() * partial.back();
  }
  return partial;
}

/// Schwarz's criterion.
double LogBayesOf(const std::vector<double>& partial, std::size_t order, int pairs) {
  double log_bayes = -0.5 * static_cast<double>(order) * std::log(std::max(1, pairs));
  for (std::size_t k = 0; k < order; ++k) log_bayes -= 0.5 * pairs * std::log1p(-partial[k] * partial[k]);
  return log_bayes;
}

}  // namespace

std::vector<Forecast> ForecastsOf(const Autoregression& series) {
  std::vector<Forecast> forecasts(1);
  for (const double partial : series.partial) {
    const Forecast& nearer = forecasts.back();
    forecasts.push_back({WithOneMore(nearer.weights, partial), nearer.left * std::sqrt(1.0 - partial * partial)});
  }
  return forecasts;
}

Autoregression InOne(const Autoregression& first, const Autoregression& second) {
  // The same that was not all taken out at once: one, as slow as both together.
  if (first.Order() == 1 && second.Order() == 1)
    return {{1.0 - (1.0 - first.partial[0]) * (1.0 - second.partial[0])}};
  const std::vector<double> a = WeightsOf(first), b = WeightsOf(second);
  std::vector<double> weights(a.size() + b.size());
  for (std::size_t i = 0; i < a.size(); ++i) weights[i] += a[i];
  for (std::size_t j = 0; j < b.size(); ++j) weights[j] += b[j];
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) weights[i + j + 1] -= a[i] * b[j];
  }
  return FromWeights(std::move(weights));
}

FittedAutoregression FitAutoregression(const Eigen::VectorXd& z, const std::vector<int>& before, int step) {
  constexpr int kMostOrder = 8, kPairsAnOrder = 400;  // of few readings, what has no name would look like noise
  constexpr double kMostCorrelated = 0.95, kWorthIt = 6.0, kSwingsBack = -0.3;
  const Products neighbours = ProductsOf(z, before, 1, step);
  // Projection makes white residuals look anticorrelated: only a positive excess counts.
  const double rho =
      neighbours.squares > 0.0 ? std::clamp(neighbours.sum / neighbours.squares, 0.0, kMostCorrelated) : 0.0;
  FittedAutoregression best{{{rho}}, LogBayesOf({rho}, 1, neighbours.pairs)};
  const int most = std::min(kMostOrder, neighbours.pairs / kPairsAnOrder);
  if (best.log_bayes < kWorthIt || most < 2) return best;
  std::vector<double> correlations;
  for (int apart = 1; apart <= most; ++apart)
    correlations.push_back(ProductsOf(z, before, apart, step).sum / neighbours.squares);
  const std::vector<double> partial = PartialOf(correlations);
  // What goes on and on may be an error without a name; noise of a longer memory is that which swings back.
  if (partial.size() < 2 || partial[1] > kSwingsBack) return best;
  for (std::size_t order = 2; order <= partial.size(); ++order) {
    const double log_bayes = LogBayesOf(partial, order, neighbours.pairs);
    if (log_bayes < best.log_bayes + kWorthIt) continue;
    best = {{{partial.begin(), partial.begin() + static_cast<std::ptrdiff_t>(order)}}, log_bayes};
  }
  return best;
}

}  // namespace twinbench::diagnose
