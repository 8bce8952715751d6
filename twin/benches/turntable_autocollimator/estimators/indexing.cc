#include "twin/benches/turntable_autocollimator/estimators/indexing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <utility>

#include "twin/benches/turntable_autocollimator/estimators/lost_harmonics.h"
#include "twin/core/distributions.h"
#include "twin/core/units.h"
#include "twin/separate/mean.h"

namespace twinbench::separate::turntable {
namespace {

constexpr double kTooUnlikely = 0.001;

/// Variance of one reading about the turntable's axis, of readings with roll.
double Variance(const AutocollimatorNoise& noise, double gamma_rad) {
  return std::pow(std::cos(gamma_rad) * noise.u_x_rad, 2) + std::pow(std::sin(gamma_rad) * noise.u_y_rad, 2);
}

/// Of all residuals, or of the means of the passes at a stop of a set-up.
struct Squares {
  double sum_rad2 = 0.0, dof = 0.0;

  /// Of residual on noise (Birge) where it is beyond chance, else 1.
  double Scale(double variance_rad2) const {
    const double chi2 = sum_rad2 / variance_rad2;
    return dof > kLeastDof && ChiSquaredExceedance(chi2, dof) < kTooUnlikely ? std::sqrt(chi2 / dof) : 1.0;
  }
};

/// What all passes repeat, their scatter would thin out.
Squares SquaresOfMeans(const Eigen::VectorXd& residual_rad, const StopGrid& grid, double dof) {
  std::map<std::pair<int, int>, Mean> means;
  for (Eigen::Index i = 0; i < residual_rad.size(); ++i) {
    const GridStop& stop = grid.stops[static_cast<std::size_t>(i)];
    if (std::isfinite(residual_rad[i])) means[{stop.setup, stop.position}].Add(residual_rad[i]);
  }
  Squares squares{0.0, dof};
  for (const auto& [where, mean] : means) {
    squares.sum_rad2 += mean.count * mean.Value() * mean.Value();
    squares.dof -= mean.count - 1.0;
  }
  return squares;
}

/// Compares the residuals with the noise: scales it, or takes it from them if there is none.
void JudgeNoise(const Eigen::VectorXd& residual_rad, const StopGrid& grid, double gamma_rad, IndexingSeparation& result) {
  result.residual_rms_rad = std::sqrt(residual_rad.squaredNorm() / static_cast<double>(residual_rad.size()));
  if (!(result.dof > kLeastDof)) return;
  const Squares of_all{residual_rad.squaredNorm(), result.dof}, of_means = SquaresOfMeans(residual_rad, grid, result.dof);
  if (std::isfinite(result.noise.u_x_rad)) {
    const double variance_rad2 = Variance(result.noise, gamma_rad);
    result.chi2 = of_all.sum_rad2 / variance_rad2;
    result.scale = std::max(of_all.Scale(variance_rad2), of_means.Scale(variance_rad2));
  } else {
    const double u_rad = std::sqrt(of_all.sum_rad2 / of_all.dof);
    result.noise = {u_rad, u_rad, static_cast<int>(std::lround(result.dof))};
    result.scale = of_means.Scale(u_rad * u_rad);
  }
  if (result.scale == 1.0) return;
  if (result.roll.status == RollStatus::kOk) result.roll.u_gamma_rad *= result.scale;
  result.notes.push_back(fmt::format(
      "the residuals are {:.2f} times what the noise explains: uncertainties are scaled", result.scale));
}

/// Covariance, by how many positions lie between, of what the turntable holds of the multi-tooth table: the part
/// that looks alike at positions of the same remainder by the common steps, of a mean over the rows of teeth.
Eigen::VectorXd MultitoothLags(const StopGrid& grid, int common_steps, double u_multitooth_rad) {
  const double variance = u_multitooth_rad * u_multitooth_rad / static_cast<double>(grid.row_offset_rad.size());
  Eigen::VectorXd lags(grid.n);
  for (int lag = 0; lag < grid.n; ++lag)
    lags[lag] = variance / grid.n * ((lag % common_steps == 0 ? common_steps : 0) - 1);
  return lags;
}

/// The same for the positions that were read.
CurveCovariance MultitoothPart(const Eigen::VectorXd& lags, const std::vector<int>& positions) {
  const Eigen::Index n = lags.size(), count = std::ssize(positions);
  if (count == n) return CurveCovariance::Circulant(lags, 1);
  Eigen::MatrixXd cov(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index j = 0; j < count; ++j)
      cov(i, j) = lags[std::abs(positions[static_cast<std::size_t>(i)] - positions[static_cast<std::size_t>(j)])];
  }
  return CurveCovariance::Dense(std::move(cov));
}

/// Places of one table that were read, by ascending angle: their unknowns of the fit.
struct ReadPlaces {
  std::vector<double> angle_rad;
  std::vector<int> unknown;
};

ReadPlaces PlacesOf(const std::map<double, int>& read) {
  ReadPlaces places;
  for (const auto& [angle_rad, unknown] : read) {
    places.angle_rad.push_back(angle_rad);
    places.unknown.push_back(unknown);
  }
  return places;
}

/// What the uncertainty of both tables is made of.
struct Sources {
  double of_reading_rad2 = kNaN;  // variance of one
  Eigen::VectorXd of_roll_rad;    // change of each unknown with one standard uncertainty of the roll
};

AngleSeries MakeSeries(const ShiftFit& fit, const Eigen::VectorXd& unknowns, const Sources& sources,
                       const ReadPlaces& places) {
  AngleSeries series;
  series.position_rad = places.angle_rad;
  series.value_rad = unknowns(places.unknown);
  series.cov_rad2 = fit.Cofactor(places.unknown) * sources.of_reading_rad2;
  series.sources = {sources.of_roll_rad(places.unknown)};
  series.cov_rad2.AddProduct(series.sources->of_roll_rad);
  return series;
}

void AddTeeth(const CurveCovariance& of_teeth_rad2, AngleSeries& series) {
  series.cov_rad2.Add(of_teeth_rad2);
  series.sources->of_teeth_rad2 = of_teeth_rad2;
}

IndexingStatus StatusOf(const ShiftFit& fit, int n) {
  if (!fit.determined()) return IndexingStatus::kUndetermined;
  if (fit.common_steps() == 1) return IndexingStatus::kSeparated;
  return fit.common_steps() == n ? IndexingStatus::kSumOnly : IndexingStatus::kHarmonicsLost;
}

void AddNotes(const Eigen::VectorXd& d_roll, int n, IndexingSeparation& result) {
  if (result.status == IndexingStatus::kUndetermined)
    result.notes.push_back("readings are missing: the remaining ones do not connect all positions");
  if (result.status == IndexingStatus::kSumOnly)
    result.notes.push_back(
        "the shifts do not separate the tables: the turntable's values hold the multi-tooth table's");
  if (result.status == IndexingStatus::kHarmonicsLost)
    result.notes.push_back(fmt::format("orders {} are the same for all shifts and counted as the turntable's",
                                       fmt::join(result.lost_harmonics, ", ")));
  if (result.status != IndexingStatus::kUndetermined && !std::isfinite(result.roll.gamma_rad)) {
    const double change_arcsec = d_roll.head(n).array().isNaN().select(0.0, d_roll.head(n)).cwiseAbs().maxCoeff() *
                                 units::deg / units::arcsec;
    if (change_arcsec == 0.0) return;  // nobody saw a tilt
    result.notes.push_back(
        fmt::format("the roll of the crosshair is not determined and not taken out; 1 deg of it "
                    "would change the turntable's error by up to {:.3f} arcsec",
                    change_arcsec));
  }
}

Roll Given(Roll roll) {
  roll.status = RollStatus::kGiven;
  return roll;
}

/// @param d_roll  Change of the unknowns with the roll [rad / rad].
Sources SourcesOf(const Eigen::VectorXd& d_roll, double gamma_rad, const IndexingSeparation& result) {
  const double u_roll_rad = std::isfinite(result.roll.u_gamma_rad) ? result.roll.u_gamma_rad : 0.0;
  return {result.scale * result.scale * Variance(result.noise, gamma_rad), u_roll_rad * d_roll};
}

void FillTables(const StopGrid& grid, const ShiftFit& fit, const Eigen::VectorXd& unknowns, const Sources& sources,
                double u_multitooth_rad, IndexingSeparation& result) {
  std::map<double, int> positions, teeth;
  for (const GridStop& stop : grid.stops) {
    positions[grid.Position_rad(stop.position)] = stop.position;
    teeth[grid.Tooth_rad(stop.tooth)] = grid.n + stop.tooth;
  }
  const ReadPlaces turntable = PlacesOf(positions);
  result.turntable = MakeSeries(fit, unknowns, sources, turntable);
  AddTeeth(MultitoothPart(MultitoothLags(grid, fit.common_steps(), u_multitooth_rad), turntable.unknown),
           result.turntable);
  if (result.status != IndexingStatus::kSumOnly)
    result.multitooth = MakeSeries(fit, unknowns, sources, PlacesOf(teeth));
}

/// Values of the grid's stops, spread over all stops handed in.
Eigen::VectorXd ByStop(const Eigen::VectorXd& values, const StopGrid& grid, Eigen::Index stops) {
  Eigen::VectorXd spread = Eigen::VectorXd::Constant(stops, kNaN);
  for (Eigen::Index k = 0; k < values.size(); ++k)
    spread[static_cast<Eigen::Index>(grid.stops[static_cast<std::size_t>(k)].stop)] = values[k];
  return spread;
}

}  // namespace

IndexingSeparation SeparateIndexing(const std::vector<TurntableStop>& stops, const IndexingOptions& options) {
  const StopGrid grid = FindGrid(stops, options.positions);
  const Readings readings = Collect(stops, grid);
  const ShiftFit fit(grid);
  IndexingSeparation result;
  result.status = StatusOf(fit, grid.n);
  result.lost_harmonics = LostHarmonics(grid.n, fit.common_steps());
  result.noise = options.noise ? *options.noise : NoiseOfRepeats(stops, grid);
  result.roll =
      options.roll ? Given(*options.roll) : EstimateRoll(fit, readings.x_rad, readings.y_rad, result.noise);
  result.dof = fit.dof() - (result.roll.status == RollStatus::kOk ? 1.0 : 0.0);

  const double gamma_rad = std::isfinite(result.roll.gamma_rad) ? result.roll.gamma_rad : 0.0;
  const double c = std::cos(gamma_rad), s = std::sin(gamma_rad);
  const Eigen::VectorXd x_rad = c * readings.x_rad - s * readings.y_rad;
  const Eigen::VectorXd d_roll = fit.Solve(-s * readings.x_rad - c * readings.y_rad);
  const Eigen::VectorXd residual_rad = fit.Residuals(x_rad);
  JudgeNoise(residual_rad, grid, gamma_rad, result);
  result.residual_rad = ByStop(residual_rad, grid, std::ssize(stops));
  FillTables(grid, fit, fit.Solve(x_rad), SourcesOf(d_roll, gamma_rad, result), options.u_multitooth_rad, result);
  AddNotes(d_roll, grid.n, result);
  return result;
}

}  // namespace twinbench::separate::turntable
