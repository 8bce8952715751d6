#include "twin/diagnose/gain.h"

#include <algorithm>
#include <map>
#include <utility>

#include "twin/core/errors.h"
#include "twin/core/stream.h"
#include "twin/diagnose/accepted_columns.h"
#include "twin/diagnose/engine/projector.h"

namespace twinbench::diagnose {
namespace {

using Sparse = Eigen::SparseMatrix<double, Eigen::RowMajor>;

constexpr int kBlockReadings = 6;
constexpr int kDraws = 1000;
constexpr int kTimeFolds = 4;  // of a run without repeated passes
/// Held-out rows stay in the fit with this weight: it moves the fit by 1e-8 of their noise and lets their leverage
/// tell how well the other rows predict them.
constexpr double kTrace = 1e-4;
constexpr double kNoise = 2.0;  // standard deviations of the noise that a remainder must exceed to count
constexpr double kDeterminedVariance =
    100.0;  // of a prediction, in units of the row's noise; else it is not scored

std::size_t At(int i) {
  return static_cast<std::size_t>(i);
}

/// Sums over held-out rows, in units of the noise.
struct Sums {
  double before = 0.0, after = 0.0, floor = 0.0;
  double scatter = 0.0;  // variance of `after` by noise alone
  double weight = 0.0;   // sum of 1 / sigma^2 [1/m^2]

  Sums& operator+=(const Sums& other) {
    before += other.before;
    after += other.after;
    floor += other.floor;
    scatter += other.scatter;
    weight += other.weight;
    return *this;
  }
  double Removed() const { return before - after; }
  /// What `after` has above the floor, as far as it is not within `deviations` of the noise.
  double Remaining(double deviations) const {
    return after - floor > deviations * std::sqrt(scatter) ? after - floor : 0.0;
  }
  double Fraction(double deviations) const {
    if (Removed() > 0.0) return Removed() / (Removed() + Remaining(deviations));
    return before > floor ? Removed() / (before - floor) : 0.0;  // nothing to remove, and nothing removed
  }
  double Rms(double sum) const { return std::sqrt(sum / weight); }
};

/// Errors of the predictions of one fold's rows, before and after, in SI; NaN for rows that are not scored.
struct FoldErrors {
  Eigen::VectorXd before, after;
  Eigen::VectorXd variance;  // of the prediction, in units of the row's noise
};

/// Rows that are held out keep `kTrace` of themselves; J and S unwhitened, so that their variance is that of the
/// raw prediction.
template <typename Matrix>
Matrix Mixed(const LinearRun& run, const NoiseModel& noise, const Eigen::VectorXd& held, const Matrix& rows) {
  const Eigen::VectorXd train = 1.0 - held.array();
  const Eigen::VectorXd trace = kTrace * held.array() / noise.sigma.array();
  Matrix white = train.asDiagonal() * noise.Whiten(run, rows);
  return white + Matrix(trace.asDiagonal() * rows);
}

/// Fits the rows where `held` is 0 and predicts those where it is 1.
FoldErrors PredictFold(const LinearRun& run, const NoiseModel& noise, const Columns& columns,
                       const Eigen::VectorXd& held) {
  const Projector fit(Mixed(run, noise, held, run.nuisance.jacobian), run.nuisance);
  const Eigen::MatrixXd raw_y = run.residual;
  const Eigen::MatrixXd train_y = (1.0 - held.array()).matrix().asDiagonal() * noise.Whiten(run, raw_y);
  const Eigen::MatrixXd S = Mixed(run, noise, held, columns.S);
  const Eigen::VectorXd amplitudes = FitAmplitudes(fit, S, train_y, columns.prior_precision);
  FoldErrors errors;
  errors.before = run.residual - run.nuisance.jacobian * fit.Solve(train_y);
  errors.after =
      run.residual - columns.S * amplitudes - run.nuisance.jacobian * fit.Solve(train_y - S * amplitudes);
  errors.variance = (1.0 - fit.Redundancy().array()) / (kTrace * kTrace);
  return errors;
}

/// One number a block of consecutive readings of a set-up, phase and pass.
std::vector<int> BlockOfReading(const Schedule& s) {
  std::map<std::pair<int, int>, int> seen;  // readings of a set-up and pass so far
  std::map<std::pair<std::pair<int, int>, int>, int> number;
  std::vector<int> block(At(s.Readings()));
  for (int i = 0; i < s.Readings(); ++i) {
    const std::pair<int, int> sweep = {s.setup[At(i)], s.pass[At(i)]};
    const int in_sweep = seen[sweep]++ / kBlockReadings;
    block[At(i)] = number.try_emplace({sweep, in_sweep}, static_cast<int>(number.size())).first->second;
  }
  return block;
}

void AddFold(const LinearRun& run, const NoiseModel& noise, const FoldErrors& errors, const Eigen::VectorXd& held,
             const std::vector<int>& block_of, std::vector<Sums>& blocks) {
  for (int k = 0; k < run.Rows(); ++k) {
    if (held[k] == 0.0 || !(errors.variance[k] < kDeterminedVariance)) continue;
    const double weight = 1.0 / (noise.sigma[k] * noise.sigma[k]);
    const auto squared = [](double x) { return x * x; };
    const double floor = 1.0 + errors.variance[k];
    blocks[At(block_of[At(run.ReadingOf(k))])] +=
        {weight * squared(errors.before[k]), weight * squared(errors.after[k]), floor, 2.0 * floor * floor, weight};
  }
}

double Quantile(const std::vector<double>& sorted, double q) {
  return sorted.empty() ? kNaN : sorted[static_cast<std::size_t>(q * static_cast<double>(sorted.size() - 1) + 0.5)];
}

/// Draws blocks with replacement and fills what follows from the draws.
void Bootstrap(const std::vector<Sums>& blocks, Gain& gain) {
  Stream stream(1, "diagnose.gain");
  std::vector<double> fractions, removed;
  for (int draw = 0; draw < kDraws; ++draw) {
    Sums sum;
    for (std::size_t b = 0; b < blocks.size(); ++b)
      sum += blocks[static_cast<std::size_t>(stream.Uniform() * static_cast<double>(blocks.size()))];
    removed.push_back(sum.Removed());
    if (const double fraction = sum.Fraction(0.0); std::isfinite(fraction)) fractions.push_back(fraction);
  }
  std::sort(fractions.begin(), fractions.end());
  std::sort(removed.begin(), removed.end());
  gain.interval95 = {Quantile(fractions, 0.025), Quantile(fractions, 0.975)};
  gain.positive = Quantile(removed, 0.025) > 0.0;
}

/// Whether each row belongs to a fold, as 1 or 0.
Eigen::VectorXd HeldRows(const LinearRun& run, const Folds& folds, int fold) {
  Eigen::VectorXd held(run.Rows());
  for (int k = 0; k < run.Rows(); ++k) held[k] = folds.of_reading[At(run.ReadingOf(k))] == fold ? 1.0 : 0.0;
  return held;
}

/// The full-circle passes of each set-up in the order of their first readings.
std::map<int, std::vector<int>> PassesOfSetups(const Schedule& s) {
  std::map<int, std::vector<int>> passes;
  for (int i = 0; i < s.Readings(); ++i) {
    if (s.phase[At(i)] != Phase::kFullCircle) continue;
    std::vector<int>& known = passes[s.setup[At(i)]];
    if (std::find(known.begin(), known.end(), s.pass[At(i)]) == known.end()) known.push_back(s.pass[At(i)]);
  }
  return passes;
}

/// Folds by blocks of time for all readings that have none.
void AddFoldsOfTime(Folds& folds) {
  int in_turn = 0;
  for (int& fold : folds.of_reading) {
    if (fold < 0) fold = in_turn++ / kBlockReadings % folds.count;
  }
}

}  // namespace

Folds MakeFolds(const Schedule& s) {
  const auto passes = PassesOfSetups(s);
  Folds folds{std::vector<int>(At(s.Readings()), -1), 0};
  for (int i = 0; i < s.Readings(); ++i) {
    if (s.phase[At(i)] != Phase::kFullCircle) continue;
    const std::vector<int>& known = passes.at(s.setup[At(i)]);
    if (known.size() < 2) continue;
    const auto place = std::find(known.begin(), known.end(), s.pass[At(i)]) - known.begin();
    folds.of_reading[At(i)] = static_cast<int>(place);
    folds.count = std::max(folds.count, static_cast<int>(place) + 1);
  }
  if (folds.count == 0) folds.count = kTimeFolds;
  AddFoldsOfTime(folds);
  return folds;
}

Gain MeasureGain(const LinearRun& run, const NoiseModel& noise, const std::vector<Accepted>& accepted) {
  Gain gain;
  if (accepted.empty()) return gain;
  const Columns columns = ColumnsOf(accepted, run.Rows());
  const Folds folds = MakeFolds(run.schedule);
  const std::vector<int> block_of = BlockOfReading(run.schedule);
  std::vector<Sums> blocks(At(1 + *std::max_element(block_of.begin(), block_of.end())));
  for (int fold = 0; fold < folds.count; ++fold) {
    const Eigen::VectorXd held = HeldRows(run, folds, fold);
    AddFold(run, noise, PredictFold(run, noise, columns, held), held, block_of, blocks);
  }
  std::erase_if(blocks, [](const Sums& block) { return block.weight == 0.0; });
  if (blocks.empty()) return gain;
  Sums all;
  for (const Sums& block : blocks) all += block;
  gain.folds = folds.count;
  gain.before_m = all.Rms(all.before);
  gain.after_m = all.Rms(all.after);
  gain.noise_floor_m = all.Rms(all.floor);
  Bootstrap(blocks, gain);
  gain.fraction_removed =
      gain.positive ? all.Fraction(kNoise) : all.Removed() / std::max(all.before - all.floor, 0.0);
  if (!std::isfinite(gain.fraction_removed)) gain.fraction_removed = kNaN;
  return gain;
}

}  // namespace twinbench::diagnose
