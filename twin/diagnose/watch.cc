#include "twin/diagnose/watch.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "twin/core/distributions.h"
#include "twin/core/errors.h"
#include "twin/core/linear_algebra.h"
#include "twin/diagnose/sequential_fit.h"

namespace twinbench::diagnose {
namespace {

constexpr double kReference = 0.5;         // of the cumulative sums, in standard deviations
constexpr double kStatedRows = 30.0;       // that the stated noise counts for
constexpr double kMostOfOneRow = 9.0;      // an outlier must not widen the limits that should see it ...
constexpr double kMostOfOneReading = 4.0;  // ... nor be taken for a lasting deviation, in standard deviations
constexpr double kNear = 2.5;              // to a prediction, in standard deviations ...
constexpr int kNearReadings = 3;           // ... so often running: the event is over

/// What one reading says of a series: deviation and its variance [SI].
struct Deviation {
  double value = 0.0;
  double variance = 0.0;
  double z = 0.0;
};

/// One side of a cumulative sum.
class CumulativeSum {
 public:
  void Add(const Deviation& d, double z, int reading) {
    value_ = std::max(0.0, value_ + std::min(z, kMostOfOneReading) - kReference);
    if (value_ == 0.0) {
      *this = {};
      return;
    }
    if (since_ < 0) since_ = reading;
    weighted_ += d.value / d.variance;
    weight_ += 1.0 / d.variance;
  }
  double value() const { return value_; }
  Alarm ToAlarm(int reading) const {
    Alarm alarm;
    alarm.reading = reading;
    alarm.since = since_;
    alarm.lasting = true;
    alarm.size = weighted_ / weight_;
    alarm.u_size = std::sqrt(1.0 / weight_);
    alarm.z = value_;
    return alarm;
  }

 private:
  double value_ = 0.0;
  int since_ = -1;
  double weighted_ = 0.0, weight_ = 0.0;
};

/// A channel or a pattern with its charts.
struct WatchedSeries {
  std::string name;
  Eigen::VectorXd weight;  // largest entry 1
  CumulativeSum up = {}, down = {};
  bool silent = false;  // for good
  int held = 0;         // readings that must be near their predictions until it speaks again

  bool Shares(const WatchedSeries& other) const {
    return (weight.array() != 0.0 && other.weight.array() != 0.0).any();
  }
};

std::vector<WatchedSeries> AllSeries(const LinearRun& run) {
  std::vector<WatchedSeries> all;
  for (int c = 0; c < run.Channels(); ++c) {
    all.push_back({run.channels[static_cast<std::size_t>(c)], Eigen::VectorXd::Unit(run.Channels(), c)});
  }
  for (const Pattern& pattern : run.patterns) {
    if (run.Channels() < 2 || pattern.weight.size() != run.Channels()) continue;
    all.push_back({pattern.name, pattern.weight / pattern.weight.cwiseAbs().maxCoeff()});
  }
  return all;
}

/// A reading against its prediction: deviations of the channels and their covariance, both in units of the noise.
struct Innovation {
  Eigen::VectorXd error;
  Eigen::MatrixXd covariance;
  Eigen::VectorXd sigma;

  bool Determines(const Eigen::VectorXd& weight) const {
    return (weight.array() == 0.0 || covariance.diagonal().array() < kDeterminedVariance).all();
  }
  PredictedReading Told(int reading) const {
    PredictedReading told{reading, error.cwiseProduct(sigma), covariance.diagonal().cwiseSqrt().cwiseProduct(sigma)};
    for (Eigen::Index c = 0; c < error.size(); ++c) {
      if (!(covariance(c, c) < kDeterminedVariance)) told.deviation[c] = told.u[c] = kNaN;
    }
    return told;
  }
  /// Channels by themselves; patterns by their best estimate.
  Deviation Of(const WatchedSeries& series) const {
    Eigen::Index channel = 0;
    const bool single = (series.weight.array() != 0.0).count() == 1 && series.weight.maxCoeff(&channel) == 1.0;
    Deviation d;
    if (single) {
      d.value = error[channel] * sigma[channel];
      d.variance = covariance(channel, channel) * sigma[channel] * sigma[channel];
    } else {
      const Eigen::VectorXd w = series.weight.cwiseQuotient(sigma);
      const Eigen::VectorXd solved = SolveSymmetric(covariance, w);
      d.variance = 1.0 / w.dot(solved);
      d.value = d.variance * solved.dot(error);
    }
    d.z = d.value / std::sqrt(d.variance);
    return d;
  }
};

/// Running noise scale: mean square of independent innovations, with the stated figure as a start.
class RunningNoiseScale {
 public:
  double value() const { return std::sqrt(sum_ / rows_); }
  void Add(const Innovation& innovation) {
    const Eigen::VectorXd independent =
        CholeskyFactorOf(innovation.covariance).triangularView<Eigen::Lower>().solve(innovation.error);
    for (const double z : independent) {
      sum_ += std::min(z * z, kMostOfOneRow * sum_ / rows_);
      rows_ += 1.0;
    }
  }

 private:
  double sum_ = kStatedRows, rows_ = kStatedRows;
};

/// Predicts readings one after the other.
class Predictor {
 public:
  explicit Predictor(const LinearRun& run) : run_(run), fit_(run.nuisance.prior_precision) {}

  Innovation Predict(int reading) {
    const int channels = run_.Channels(), first = reading * channels;
    Innovation next;
    next.sigma = run_.sigma.segment(first, channels);
    const Eigen::MatrixXd raw = run_.nuisance.jacobian.middleRows(first, channels);
    rows_ = next.sigma.cwiseInverse().asDiagonal() * raw;
    values_ = run_.residual.segment(first, channels).cwiseQuotient(next.sigma);
    next.error = values_ - rows_ * fit_.Solution();
    next.covariance = Eigen::MatrixXd::Identity(channels, channels) + fit_.CovarianceOf(rows_);
    return next;
  }

  /// Learns from the reading that was predicted, but not from channels farther off than `most` standard deviations.
  void Learn(const Innovation& innovation, double most) {
    for (Eigen::Index c = 0; c < rows_.rows(); ++c) {
      if (std::abs(innovation.error[c]) <= most * std::sqrt(innovation.covariance(c, c)))
        fit_.Absorb(rows_.row(c), values_[c]);
    }
  }

 private:
  const LinearRun& run_;
  SequentialFit fit_;
  Eigen::MatrixXd rows_;  // of the reading that was predicted, in units of the noise
  Eigen::VectorXd values_;
};

std::optional<Alarm> Judge(WatchedSeries& series, const Deviation& d, double scale, int reading,
                           const WatchLimits& limits) {
  const double z = d.z / scale;
  if (series.held > 0) {
    series.held = std::abs(z) > kNear ? kNearReadings : series.held - 1;
    return std::nullopt;
  }
  series.up.Add(d, z, reading);
  series.down.Add(d, -z, reading);
  const CumulativeSum& larger = series.up.value() >= series.down.value() ? series.up : series.down;
  Alarm alarm;
  if (larger.value() > limits.lasting) {
    alarm = larger.ToAlarm(reading);
    alarm.limit = limits.lasting;
  } else if (std::abs(z) > limits.single) {
    alarm.reading = alarm.since = reading;
    alarm.size = d.value;
    alarm.u_size = std::sqrt(d.variance);
    alarm.z = std::abs(z);
    alarm.limit = limits.single;
  } else {
    return std::nullopt;
  }
  alarm.series = series.name;
  return alarm;
}

/// One event, one alarm: the series that raised it and all that share a channel with it begin anew, those of a
/// lasting deviation never.
void Quieten(std::vector<WatchedSeries>& all, const Alarm& alarm) {
  const auto raised = std::find_if(all.begin(), all.end(), [&](const auto& s) { return s.name == alarm.series; });
  for (WatchedSeries& series : all) {
    if (!series.Shares(*raised)) continue;
    series.up = series.down = {};
    series.held = kNearReadings;
    series.silent = series.silent || alarm.lasting;
  }
}

/// Lets every series look at a reading; the one that is farthest beyond its limit speaks.
void JudgeAll(std::vector<WatchedSeries>& all, const Innovation& innovation, double scale, int reading,
              const WatchLimits& limits, WatchReport& report) {
  std::optional<Alarm> loudest;
  for (WatchedSeries& series : all) {
    if (series.silent || !innovation.Determines(series.weight)) continue;
    const auto alarm = Judge(series, innovation.Of(series), scale, reading, limits);
    if (alarm && (!loudest || alarm->z / alarm->limit > loudest->z / loudest->limit)) loudest = alarm;
  }
  if (!loudest) return;
  Quieten(all, *loudest);
  report.alarms.push_back(*loudest);
}

/// Mean readings until a one-sided cumulative sum of white noise passes h.
double MeanRunLength(double h) {
  const double b = 2.0 * kReference * (h + 1.166);
  return (std::exp(b) - b - 1.0) / (2.0 * kReference * kReference);
}

/// Where a function that rises passes a value, by bisection in [0, 60].
template <class Function>
double Solve(Function rising, double value) {
  double low = 0.0, high = 60.0;
  while (high - low > 1e-9) {
    const double middle = 0.5 * (low + high);
    (rising(middle) < value ? low : high) = middle;
  }
  return high;
}

}  // namespace

WatchLimits LimitsFor(double false_alarm_rate, int readings, int series) {
  Require(false_alarm_rate > 0.0 && false_alarm_rate < 1.0 && readings > 0 && series > 0,
          "a false-alarm rate between 0 and 1 for at least one reading");
  const double looks = static_cast<double>(readings) * series;
  const double share = 0.5 * false_alarm_rate;
  return {NormalExceededWith(0.5 * share / looks), Solve(MeanRunLength, 2.0 * looks / share)};
}

WatchReport Watch(const LinearRun& run, const WatchOptions& options) {
  WatchReport report;
  const int readings = run.schedule.Readings();
  if (readings == 0) return report;
  std::vector<WatchedSeries> all = AllSeries(run);
  const WatchLimits limits = LimitsFor(options.false_alarm_rate, std::max(readings, options.planned_readings),
                                       static_cast<int>(all.size()));
  Predictor predictor(run);
  RunningNoiseScale scale;
  for (int i = 0; i < readings; ++i) {
    const Innovation innovation = predictor.Predict(i);
    report.predicted.push_back(innovation.Told(run.schedule.reading[static_cast<std::size_t>(i)]));
    predictor.Learn(innovation, limits.single * scale.value());
    if (!innovation.Determines(Eigen::VectorXd::Ones(run.Channels()))) continue;
    ++report.judged;
    JudgeAll(all, innovation, scale.value(), run.schedule.reading[static_cast<std::size_t>(i)], limits, report);
    scale.Add(innovation);
  }
  report.noise_scale = scale.value();
  report.limit_u = limits.single * scale.value();
  return report;
}

}  // namespace twinbench::diagnose
