#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "twin/diagnose/engine/projector.h"
#include "twin/diagnose/screen/screen.h"

namespace twinbench::diagnose::screen {

/// What the tests know of a run beside its residuals.
struct Judged {
  const LinearRun& run;
  const NoiseModel& noise;
  const Projector& projector;
  Eigen::VectorXd redundancy;  // by row: what the free unknowns leave of the variance
  std::vector<std::vector<int>>
      rows;  // one a channel, in the order of the readings: those that the unknowns leave enough of

  /// Channels with at least so many of these rows.
  std::vector<int> Channels(int fewest) const;
  /// Of one channel, in standard deviations: residual / sqrt(redundancy), as many columns as the residual has.
  Eigen::MatrixXd Normalised(const Eigen::MatrixXd& residual, int channel) const;
};
Judged Judge(const LinearRun& run, const NoiseModel& noise, const Projector& projector);

/// One test. `residual` has whitened and projected residuals of all rows, a column a run.
struct Test {
  std::string name;
  std::vector<std::string> items = {};  // the channels or groupings that it looks at
  bool is_two_sided = false;            // too small is as telling as too large
  /// Items x columns: the statistics, or what of them is nearest to normal in noise.
  std::function<Eigen::MatrixXd(const Eigen::MatrixXd& residual)> scores = {};
  /// Gives the worst item its statistic, its size and its words.
  std::function<void(int item, const Eigen::VectorXd& residual, ResidualTest& test)> tell = {};
};

/// Each of them if the run has what it needs. They keep a reference to `judged`.
std::optional<Test> FitToStatedNoise(const Judged& judged);
std::optional<Test> RunsAndAutocorrelation(const Judged& judged);
std::optional<Test> Periodogram(const Judged& judged);
std::optional<Test> Normality(const Judged& judged);
std::optional<Test> VarianceByGroup(const Judged& judged);

/// Scores of a run at a time.
Eigen::MatrixXd ByColumn(const Eigen::MatrixXd& residual,
                         const std::function<Eigen::VectorXd(const Eigen::VectorXd& residual)>& scores);

/// A size on one channel, as a length (none where readings are angles) and as the rotation that moves this channel
/// most; neither where they are neither.
void SetEffect(const LinearRun& run, int channel, double size_SI, ResidualTest& test);

/// Typical standard uncertainty of a channel's readings, SI.
double TypicalSigma(const LinearRun& run, int channel);

/// Deviation of what comes beside noise of this deviation and makes it `ratio` times as large, or as small.
double Beside(double sigma, double ratio);

/// Share of nulls (all entries but the first) that are at least the run's (the first), counting the run itself.
/// Beyond the largest tenth of the nulls: an exponential with the mean of their excesses, which is too cautious for
/// statistics with Gaussian tails and never gives 0.
double PValue(const Eigen::VectorXd& statistic);

}  // namespace twinbench::diagnose::screen
