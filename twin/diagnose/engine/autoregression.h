#pragma once

#include <Eigen/Core>
#include <vector>

namespace twinbench::diagnose {

/// How each value of a stationary series goes on from those before it (Durbin, The fitting of time-series models, 1960).
struct Autoregression {
  /// By how many values apart two of them are: their correlation beside those between them, each within -1 and 1.
  /// Empty: white.
  std::vector<double> partial;

  bool IsWhite() const { return partial.empty(); }
  /// Of neighbours.
  double Correlation() const { return partial.empty() ? 0.0 : partial.front(); }
  std::size_t Order() const { return partial.size(); }
};

/// The best that some values before say of the next one.
struct Forecast {
  std::vector<double> weights;  // of the value before, of the one before that, ...
  double left = 1.0;            // standard deviation of what they do not say, in that of the series
};

/// From none to as many values before as it remembers.
std::vector<Forecast> ForecastsOf(const Autoregression& series);

/// Of what `second` describes once `first` has been taken out.
Autoregression InOne(const Autoregression& first, const Autoregression& second);

struct FittedAutoregression {
  Autoregression series;
  double log_bayes = 0.0;  // against white noise of the same size
};

/// A longer memory than of the neighbour has to be worth it, and is only looked for in a series that is long.
/// @param z       Rows of deviation about one.
/// @param before  By row: rows before it that it goes on from, each `step` rows apart.
FittedAutoregression FitAutoregression(const Eigen::VectorXd& z, const std::vector<int>& before, int step);

}  // namespace twinbench::diagnose
