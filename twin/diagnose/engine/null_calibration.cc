#include "twin/diagnose/engine/null_calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <numeric>

#include "twin/core/stream.h"
#include "twin/diagnose/engine/prior.h"

namespace twinbench::diagnose {
namespace {

namespace fs = std::filesystem;

constexpr int kBatch = 100;  // runs at a time, to bound the memory
constexpr int kVersion = 4;  // of what the key does not see: raise it when the statistic changes

Eigen::MatrixXd WhiteRuns(Stream& stream, Eigen::Index rows, Eigen::Index runs) {
  Eigen::MatrixXd noise(rows, runs);
  for (Eigen::Index k = 0; k < noise.size(); ++k) noise.data()[k] = stream.Normal();
  return noise;
}

/// In units of the noise of each row.
Eigen::MatrixXd WhiteDraws(const LinearRun& run) {
  return run.sigma.cwiseInverse().asDiagonal() * run.draws;
}

/// Whitened readings of nothing but noise: rows x runs. What is drawn once a reading all of its channels show.
Eigen::MatrixXd NoiseRuns(const LinearRun& run, Stream& stream, Eigen::Index runs) {
  Eigen::MatrixXd noise = WhiteRuns(stream, run.Rows(), runs);
  if (run.draws.cols() == 0) return noise;
  const Eigen::MatrixXd white = WhiteDraws(run);
  noise.array().colwise() *= (1.0 - white.rowwise().squaredNorm().array()).max(0.0).sqrt();
  const Eigen::Index channels = run.Channels(), readings = run.Rows() / channels;
  for (const auto& draw : white.colwise()) {
    const Eigen::MatrixXd drawn = WhiteRuns(stream, readings, runs);
    for (Eigen::Index row = 0; row < noise.rows(); ++row) noise.row(row) += draw[row] * drawn.row(row / channels);
  }
  return noise;
}

/// Number of top values that the tail is fitted to, and their mean excess over the one below.
struct Tail {
  std::size_t count;
  double start, mean_excess;
};

Tail FitTail(const std::vector<double>& sorted) {
  const std::size_t count = std::max<std::size_t>(1, sorted.size() / 10);
  const double start = sorted[sorted.size() - count - 1];
  const double sum = std::accumulate(sorted.end() - static_cast<std::ptrdiff_t>(count), sorted.end(), 0.0);
  // A slope of 1 is the steepest that odds can have on average; a luckily short sample must not beat it.
  return {count, start, std::max(1.0, sum / static_cast<double>(count) - start)};
}

std::vector<double> ReadValues(const fs::path& path) {
  std::ifstream in(path);
  std::vector<double> values;
  for (double value; in >> value;) values.push_back(value);
  return values;
}

/// By way of a temporary name, so that no reader meets half a file.
void WriteValues(const std::vector<double>& values, const fs::path& path) {
  std::error_code ignored;
  fs::create_directories(path.parent_path(), ignored);
  const fs::path partial = path.string() + ".part";
  {
    std::ofstream out(partial);
    for (const double value : values) out << fmt::format("{:.17g}\n", value);
  }
  fs::rename(partial, path, ignored);
}

/// FNV-1a.
struct Hash {
  std::uint64_t value = 14695981039346656037ULL;
  void Add(const std::string& text) {
    for (const char c : text) value = (value ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
    value = (value ^ 255U) * 1099511628211ULL;
  }
};

/// Of long runs there are fewer, for the time they take: the threshold is a fit to the top tenth.
int RunsOf(Eigen::Index rows, int runs) {
  constexpr Eigen::Index kLong = 4000;
  constexpr int kFewest = 100;
  if (rows <= kLong) return runs;
  return std::min(runs, std::max(kFewest, static_cast<int>(runs * kLong / rows)));
}

/// log of the sizes that are thought of, in units of the noise.
std::vector<double> LogSizes(const LinearRun& run, const std::vector<Family>& families) {
  std::vector<double> logs;
  for (const Family& f : families) {
    for (const Amplitude& a : f.amplitudes) {
      if (std::isfinite(a.prior_sd) && a.prior_sd > 0.0) logs.push_back(std::log(a.prior_sd / run.sigma.mean()));
    }
  }
  return logs;
}

/// A statistic knows those sizes, and among how many it looks: half a class is less than its scatter. Mean and spread tell
/// the sizes and their sum the grids, so that two runs of nearly the same noise and times have nearly always one key.
void AddSizes(const LinearRun& run, const std::vector<Family>& families, Hash& hash) {
  constexpr double kPerE = 2.0;
  const std::vector<double> logs = LogSizes(run, families);
  if (logs.empty()) return;
  double points = 0.0;
  for (const Family& f : families) points += f.grid;
  const Eigen::Map<const Eigen::ArrayXd> all(logs.data(), std::ssize(logs));
  const double spread = std::sqrt((all - all.mean()).square().mean());
  for (const double told : {all.mean(), spread, std::log(points)}) hash.Add(fmt::format("{}", std::lround(kPerE * told)));
}

/// How much of the noise each draw is.
void AddDraws(const LinearRun& run, Hash& hash) {
  constexpr double kSteps = 5.0;
  if (run.draws.cols() == 0) return;
  const Eigen::MatrixXd white = WhiteDraws(run);
  for (const auto& draw : white.colwise())
    hash.Add(fmt::format("{}", std::lround(kSteps * draw.norm() / std::sqrt(static_cast<double>(run.Rows())))));
}

}  // namespace

double NullCalibration::Threshold(double probability) const {
  const double n = static_cast<double>(sorted.size());
  const Tail tail = FitTail(sorted);
  const double in_tail = static_cast<double>(tail.count) / n;
  if (probability < in_tail) return tail.start + tail.mean_excess * std::log(in_tail / probability);
  return sorted[static_cast<std::size_t>(std::clamp((1.0 - probability) * n, 0.0, n - 1.0))];
}

double NullCalibration::PValue(double statistic) const {
  const double n = static_cast<double>(sorted.size());
  const Tail tail = FitTail(sorted);
  if (statistic > tail.start) {
    return static_cast<double>(tail.count) / n * std::exp(-(statistic - tail.start) / tail.mean_excess);
  }
  const auto above = sorted.end() - std::lower_bound(sorted.begin(), sorted.end(), statistic);
  return static_cast<double>(above) / n;
}

NullCalibration Calibrate(const LinearRun& run, const Scanner& scanner, const Projector& projector,
                          const Eigen::VectorXd& log_priors, int runs) {
  Stream stream(1, "diagnose.null");
  NullCalibration calibration;
  runs = RunsOf(run.Rows(), runs);
  for (int done = 0; done < runs; done += kBatch) {
    const Eigen::MatrixXd white = NoiseRuns(run, stream, std::min(kBatch, runs - done));
    const Evidence evidence = scanner.Scan(Project(projector, {}, white), {});
    const Eigen::VectorXd statistic = AlarmStatistic(evidence.log_bayes, log_priors);
    calibration.sorted.insert(calibration.sorted.end(), statistic.begin(), statistic.end());
  }
  std::sort(calibration.sorted.begin(), calibration.sorted.end());
  return calibration;
}

NullCalibration CalibrateCached(const LinearRun& run, const Scanner& scanner, const Projector& projector,
                                const Eigen::VectorXd& log_priors, int runs, const std::string& folder,
                                const std::string& key) {
  if (folder.empty()) return Calibrate(run, scanner, projector, log_priors, runs);
  const fs::path path = fs::path(folder) / ("null-" + key + ".txt");
  NullCalibration calibration{ReadValues(path)};
  if (std::ssize(calibration.sorted) == RunsOf(run.Rows(), runs) &&
      std::is_sorted(calibration.sorted.begin(), calibration.sorted.end())) {
    return calibration;
  }
  calibration = Calibrate(run, scanner, projector, log_priors, runs);
  WriteValues(calibration.sorted, path);
  return calibration;
}

std::string DesignKey(const LinearRun& run, const std::vector<Family>& families, int runs) {
  Hash hash;
  hash.Add(fmt::format("{} {} {} {}", kVersion, runs, run.sigma_stated, run.nuisance.jacobian.cols()));
  const Schedule& s = run.schedule;
  for (std::size_t i = 0; i < s.reading.size(); ++i) {
    hash.Add(fmt::format("{} {} {} {} {}", s.setup[i], s.pass[i], s.direction[i], s.position[i],
                         static_cast<int>(s.phase[i])));
  }
  for (const Family& f : families) {
    hash.Add(fmt::format("{} {} {}", f.effect, f.where, f.amplitudes.size()));
  }
  AddSizes(run, families, hash);
  AddDraws(run, hash);
  return fmt::format("{:016x}", hash.value);
}

}  // namespace twinbench::diagnose
