#include "twin/diagnose/gain.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "twin/core/errors.h"
#include "twin/core/stream.h"
#include "twin/diagnose/accepted_columns.h"
#include "twin/diagnose/at.h"
#include "twin/diagnose/engine/projector.h"
#include "twin/diagnose/extend.h"
#include "twin/diagnose/folds.h"
#include "twin/diagnose/held_out.h"
#include "twin/diagnose/same_pass.h"

namespace twinbench::diagnose {
namespace {

using Sparse = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// Held-out rows stay in the fit with this weight: it moves the fit by 1e-8 of their noise and lets their leverage
/// tell how well the other rows predict them.
constexpr double kTrace = 1e-4;
constexpr double kLeastInformation = 0.3;  // on an amplitude; four passes leave 0.75, or 0.67 of one direction

/// Errors of the predictions of one fold's rows, before and after, in SI; NaN for rows that are not scored.
struct FoldErrors {
  Eigen::VectorXd before, after;
  Eigen::VectorXd variance;   // of the prediction, in units of the row's noise
  Eigen::VectorXd fold_sizes, all_sizes;  // likewise: what the uncertainty of the fold's amplitudes, and of all, adds
  Eigen::VectorXd amplitude;              // relative variances of the amplitudes that it was predicted with
  double steps = 1.0;         // half the mean square of what neighbours' errors differ by in noise alone
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

/// Variance of the prediction of every held-out row, in units of its noise; NaN for the others.
Eigen::VectorXd VarianceOfHeld(const Projector& fit, const Eigen::VectorXd& held) {
  std::vector<int> rows;
  for (int k = 0; k < held.size(); ++k) {
    if (held[k] != 0.0) rows.push_back(k);
  }
  Eigen::VectorXd variance = Eigen::VectorXd::Constant(held.size(), kNaN);
  variance(rows) = (1.0 - fit.Redundancy(rows).array()) / (kTrace * kTrace);
  return variance;
}

/// What is predicted from: the causes with their amplitudes from all readings, and the file that says them.
struct Model {
  Columns columns;
  Eigen::VectorXd amplitudes;  // from all readings
  Eigen::MatrixXd covariance;  // of these, RelativeCovariance
  Eigen::VectorXd repeated;    // 1 for a column that the file has at its own readings only
  const Eigen::VectorXd& written;
};

/// What the file would show, had it these amplitudes.
Eigen::VectorXd ShownWith(const Model& model, const Eigen::VectorXd& amplitudes) {
  return model.written + model.columns.S * (amplitudes - model.amplitudes);
}

/// Variance of what is predicted with amplitudes of this covariance, by row, in units of its noise.
/// @param shown  What each amplitude shows in the rows beside the unknowns that were fitted.
Eigen::VectorXd VarianceOf(const Eigen::MatrixXd& shown, const Eigen::MatrixXd& relative_covariance,
                           const Columns& columns, const NoiseModel& noise) {
  const Eigen::MatrixXd scaled = shown * columns.prior_precision.array().rsqrt().matrix().asDiagonal();
  return (scaled * relative_covariance).cwiseProduct(scaled).rowwise().sum().cwiseQuotient(noise.sigma.cwiseAbs2());
}

/// Neighbours that are predicted from readings of their own differ by the noise of these, too: by simulation.
/// @param scored  Rows that count: their error is finite.
double StepsOfNoise(const LinearRun& run, const NoiseModel& noise, const Projector& fit, const Eigen::VectorXd& held,
                    const Eigen::VectorXd& scored) {
  constexpr int kDraws = 16;
  Eigen::MatrixXd z(run.Rows(), kDraws);
  Stream stream(1, "diagnose.gain.steps");
  for (double& value : z.reshaped()) value = stream.Normal();
  const Eigen::MatrixXd rows = noise.sigma.asDiagonal() * z;
  const Eigen::MatrixXd train = (1.0 - held.array()).matrix().asDiagonal() * noise.Whiten(run, rows);
  const Eigen::MatrixXd errors = noise.sigma.cwiseInverse().asDiagonal() * (rows - run.nuisance.jacobian * fit.Solve(train));
  double sum = 0.0, pairs = 0.0;
  for (int k = 0; k < run.Rows(); ++k) {
    const int next = k + run.Channels();
    if (std::isnan(scored[k]) || !HasNext(run.schedule, run.ReadingOf(k)) || std::isnan(scored[next])) continue;
    sum += 0.5 * (errors.row(next) - errors.row(k)).squaredNorm();
    pairs += kDraws;
  }
  return pairs > 0.0 ? sum / pairs : 1.0;
}

/// Fits the rows where `held` is 0 and predicts those where it is 1.
FoldErrors PredictFold(const LinearRun& run, const NoiseModel& noise, const Model& model,
                       const Eigen::VectorXd& held) {
  const Columns& columns = model.columns;
  const Projector fit(Mixed(run, noise, held, run.nuisance.jacobian), run.nuisance);
  const Eigen::MatrixXd raw_y = run.residual;
  const Eigen::MatrixXd train_y = (1.0 - held.array()).matrix().asDiagonal() * noise.Whiten(run, raw_y);
  const Eigen::MatrixXd S = Mixed(run, noise, held, columns.S);
  const Eigen::VectorXd amplitudes = FitAmplitudes(fit, S, train_y, columns.prior_precision);
  FoldErrors errors;
  errors.before = run.residual - run.nuisance.jacobian * fit.Solve(train_y);
  // What is only repeated is out of both: free unknowns that were fitted with it would miss it where it is not.
  const Eigen::VectorXd predicted =
      ShownWith(model, amplitudes) - columns.S * model.repeated.cwiseProduct(amplitudes);
  const Eigen::MatrixXd left = run.residual - predicted;
  const Eigen::MatrixXd train_left = (1.0 - held.array()).matrix().asDiagonal() * noise.Whiten(run, left);
  errors.after = left - run.nuisance.jacobian * fit.Solve(train_left);
  const Eigen::MatrixXd covariance = RelativeCovariance(fit, S, columns.prior_precision);
  errors.amplitude = covariance.diagonal();
  const Eigen::MatrixXd lasting = columns.S * (1.0 - model.repeated.array()).matrix().asDiagonal();
  const Eigen::MatrixXd train_lasting = (1.0 - held.array()).matrix().asDiagonal() * noise.Whiten(run, lasting);
  const Eigen::MatrixXd shown = lasting - run.nuisance.jacobian * fit.Solve(train_lasting);
  errors.fold_sizes = VarianceOf(shown, covariance, columns, noise);
  errors.all_sizes = VarianceOf(shown, model.covariance, columns, noise);
  errors.variance = VarianceOfHeld(fit, held);
  for (int k = 0; k < run.Rows(); ++k) {
    if (!(errors.variance[k] < kDeterminedVariance)) errors.before[k] = errors.after[k] = kNaN;
  }
  if (!run.sigma_stated) errors.steps = StepsOfNoise(run, noise, fit, held, errors.after);
  return errors;
}

/// The blocks' sums; rows that are not scored have no error.
void AddFold(const LinearRun& run, const NoiseModel& noise, const FoldErrors& errors,
             const std::vector<int>& block_of, std::vector<HeldOutSums>& blocks) {
  const auto squared = [](double x) { return x * x; };
  for (int k = 0; k < run.Rows(); ++k) {
    if (std::isnan(errors.after[k])) continue;
    const int reading = run.ReadingOf(k), next = k + run.Channels();
    const double sigma = noise.sigma[k];
    HeldOutSums& block = blocks[At(block_of[At(reading)])];
    block += {squared(errors.before[k] / sigma), squared(errors.after[k] / sigma), 1.0 + errors.variance[k],
              1.0 / squared(sigma)};
    block += {.fold_sizes = errors.fold_sizes[k], .all_sizes = errors.all_sizes[k]};
    if (!HasNext(run.schedule, reading) || std::isnan(errors.after[next])) continue;
    block +=
        {.steps = 0.5 * squared(errors.after[next] / noise.sigma[next] - errors.after[k] / sigma) / errors.steps, .pairs = 1.0};
  }
}

/// Whether each row belongs to a fold, as 1 or 0.
Eigen::VectorXd HeldRows(const LinearRun& run, const Folds& folds, int fold) {
  Eigen::VectorXd held(run.Rows());
  for (int k = 0; k < run.Rows(); ++k) held[k] = folds.of_reading[At(run.ReadingOf(k))] == fold ? 1.0 : 0.0;
  return held;
}

/// A run predicted fold by fold.
struct Predicted {
  int folds = 0;
  std::vector<HeldOutSums> blocks;
  double least_information = 1.0;  // share that a fold has left of what all readings say of an amplitude
};

Predicted Predict(const LinearRun& run, const NoiseModel& noise, const Model& model, const Folds& folds) {
  const std::vector<int> block_of = BlocksOfReadings(run.schedule);
  const Eigen::VectorXd full = model.covariance.diagonal();
  Predicted predicted{folds.count, {}, 1.0};
  predicted.blocks.resize(At(1 + *std::max_element(block_of.begin(), block_of.end())));
  for (int fold = 0; fold < folds.count; ++fold) {
    const FoldErrors errors = PredictFold(run, noise, model, HeldRows(run, folds, fold));
    AddFold(run, noise, errors, block_of, predicted.blocks);
    predicted.least_information =
        std::min(predicted.least_information, full.cwiseQuotient(errors.amplitude).minCoeff());
  }
  std::erase_if(predicted.blocks, [](const HeldOutSums& block) { return block.weight == 0.0; });
  return predicted;
}

/// Whether a cause predicts nothing of the readings in question.
using TellsNothing = bool (*)(const Accepted& accepted, const LinearRun& run);

Model ModelOf(const LinearRun& run, const NoiseModel& noise, const std::vector<Accepted>& accepted,
              const Eigen::VectorXd& written, TellsNothing tells_nothing) {
  Model model{ColumnsOf(accepted, run.Rows()), {}, {}, {}, written};
  const Projector all(noise.Whiten(run, run.nuisance.jacobian), run.nuisance);
  const Eigen::MatrixXd y = run.residual;
  const Eigen::MatrixXd S = noise.Whiten(run, model.columns.S);
  model.amplitudes = FitAmplitudes(all, S, noise.Whiten(run, y), model.columns.prior_precision);
  model.covariance = RelativeCovariance(all, S, model.columns.prior_precision);
  model.repeated.resize(model.amplitudes.size());
  Eigen::Index column = 0;
  for (const Accepted& a : accepted) {
    model.repeated.segment(column, a.columns.cols()).setConstant(tells_nothing(a, run) ? 1.0 : 0.0);
    column += a.columns.cols();
  }
  return model;
}

Gain GainOf(const LinearRun& run, const NoiseModel& noise, const Model& model) {
  Gain gain;
  Predicted predicted = Predict(run, noise, model, MakeFolds(run.schedule));
  if (predicted.least_information < kLeastInformation) {
    Predicted by_time = Predict(run, noise, model, FoldsOfTime(run.schedule));
    if (by_time.least_information > predicted.least_information) predicted = std::move(by_time);
  }
  if (predicted.blocks.empty()) return gain;
  gain.folds = predicted.folds;
  FillGain(predicted.blocks, run.sigma_stated, noise.memory.Correlation(), gain);
  return gain;
}

/// A table by time tells of this run's readings and not of another's.
bool IsOfThisRun(const Accepted& accepted, const LinearRun& run) {
  return IsTabulated(accepted, run) && !IsRepeatedOnly(accepted, run);
}

}  // namespace

Gain MeasureGain(const LinearRun& run, const NoiseModel& noise, const std::vector<Accepted>& accepted,
                 const Eigen::VectorXd& written) {
  if (accepted.empty()) return {};
  Gain gain = GainOf(run, noise, ModelOf(run, noise, accepted, written, IsRepeatedOnly));
  gain.has_tables_of_run = std::ranges::any_of(accepted, [&](const Accepted& a) { return IsOfThisRun(a, run); });
  if (gain.has_tables_of_run)
    gain.another_run = GainOf(run, noise, ModelOf(run, noise, accepted, written, IsTabulated)).another_run;
  return gain;
}

Eigen::VectorXd ShownByFit(const LinearRun& run, const std::vector<Accepted>& accepted) {
  Eigen::VectorXd shown = Eigen::VectorXd::Zero(run.Rows());
  for (const Accepted& a : accepted) shown += a.columns * a.amplitudes;
  return shown;
}

}  // namespace twinbench::diagnose
