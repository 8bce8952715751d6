#include "twin/benches/encoder_comparison/diagnosis/told.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "twin/benches/encoder_comparison/diagnosis/families.h"
#include "twin/benches/encoder_comparison/diagnosis/memory.h"
#include "twin/benches/encoder_comparison/diagnosis/twin_fit.h"
#include "twin/core/linear_algebra.h"
#include "twin/core/units.h"
#include "twin/diagnose/tuning.h"
#include "twin/model/signals.h"

namespace twinbench::diagnose::encoder {
namespace {

/// @param order  Of a wave that has one.
bool IsPiece(const std::string& effect, std::optional<double> order) {
  constexpr double kLow = 4.0;
  return effect == "scale" || effect == "ellipticity" || (effect == "periodic" && order && *order <= kLow);
}

bool IsPiece(const Accepted& accepted) {
  const bool has_order = accepted.shape.size() == 1;
  return accepted.family.kind == Kind::kNamed &&
         IsPiece(accepted.family.effect, has_order ? std::optional(accepted.shape[0]) : std::nullopt);
}

bool IsPiece(const Cause& cause) {
  const auto order = std::ranges::find(cause.parameters, "order", &ParameterEstimate::name);
  return IsPiece(cause.effect, order != cause.parameters.end() ? std::optional(order->value) : std::nullopt);
}

/// Free numbers, which a wave has to be no more than.
Eigen::Index NumbersOf(const Accepted& accepted) {
  return accepted.family.effect == "scale" ? accepted.columns.cols() : 2;
}

/// Of these columns beside an offset of each set-up, and the power of what they leave in units of noise.
struct ColumnsFit {
  Eigen::VectorXd sizes, white_left;
  double left = 0.0;
};

ColumnsFit FitTo(const Eigen::VectorXd& rows, const LinearRun& run, const Eigen::MatrixXd& columns) {
  Eigen::MatrixXd all(rows.size(), columns.cols() + run.nuisance.jacobian.cols());
  all << columns, run.nuisance.jacobian.toDense();
  const Eigen::VectorXd weight = run.sigma.cwiseInverse();
  const Eigen::MatrixXd white = weight.asDiagonal() * all;
  const Eigen::VectorXd data = weight.cwiseProduct(rows);
  const Eigen::VectorXd sizes = SolveShortest(white, data);
  const Eigen::VectorXd white_left = data - white * sizes;
  return {sizes.head(columns.cols()), white_left, white_left.squaredNorm()};
}

}  // namespace

void TellOrFirstOrder(const SignalContext& context, DiagnosisRun& result) {
  constexpr double kLeastPart = 0.125;  // of a turn: in less any curve is a piece of a wave
  const bool is_part = LeastOrder(context) > 1 && RangeOfSetUp_rad(context) > kLeastPart * units::turn;
  if (!is_part || context.device.turn_m > 0.0) return;
  const LinearRun& run = result.run;
  Eigen::VectorXd rows = run.residual, pieces = Eigen::VectorXd::Zero(rows.size());
  Eigen::Index numbers = 0;
  for (const Accepted& accepted : result.accepted) {
    const Eigen::VectorXd shown = accepted.columns * accepted.amplitudes;
    (IsPiece(accepted) ? pieces : rows) += (IsPiece(accepted) ? 1.0 : -1.0) * shown;
    if (IsPiece(accepted)) numbers += NumbersOf(accepted);
  }
  if (numbers < 2) return;
  const ColumnsFit by_pieces = FitTo(rows - pieces, run, Eigen::MatrixXd(rows.size(), 0)), by_order = FitTo(rows, run, model::Wave(context.device_rad));
  if (by_order.left > by_pieces.left + kBetter) return;
  Diagnosis& d = result.diagnosis;
  for (Cause& cause : d.causes) {
    if (!IsPiece(cause)) continue;
    cause.indistinguishable_from.push_back({"eccentricity", "", 1.0});
    cause.next_measurement = "the rest of the turn, which distinguishes an error once per turn from a scale and higher orders";
  }
  if (d.verdict == Verdict::kNamed) d.verdict = Verdict::kTie;
  d.notes.push_back(fmt::format("an error once per turn (eccentricity) of {:.3g} {} leaves no more than the scale and the low orders together",
                                by_order.sizes.norm() / run.to_SI, run.unit));
}

namespace {

/// Of a wave that has not been seen to repeat.
bool IsHardlySeen(const std::string& effect, double order, const SignalContext& context) {
  constexpr double kPeriods = 2.0;
  return effect == "periodic" && order * RangeOfSetUp_rad(context) < kPeriods * units::turn;
}

double OrderOf(const Accepted& accepted) {
  return accepted.family.kind == Kind::kNamed && accepted.shape.size() == 1 ? accepted.shape[0] : kNaN;
}

/// Powers of the angle from 1 on, about the middle of the run.
Eigen::MatrixXd PowersOf(const Eigen::VectorXd& angle_rad, Eigen::Index degree) {
  const double least_rad = angle_rad.minCoeff(), range_rad = angle_rad.maxCoeff() - least_rad;
  const Eigen::ArrayXd x = 2.0 * (angle_rad.array() - least_rad) / range_rad - 1.0;
  Eigen::MatrixXd powers(angle_rad.size(), degree);
  for (Eigen::Index k = 0; k < degree; ++k) powers.col(k) = x.pow(static_cast<double>(k + 1)).matrix();
  return powers;
}

/// What stands for a curve among what was found, and the readings that it has to explain.
struct CurvePieces {
  Eigen::VectorXd rows;
  Eigen::MatrixXd columns;
  Eigen::Index numbers = 0;  // chosen orders count
};

CurvePieces PiecesOf(const SignalContext& context, const DiagnosisRun& result) {
  CurvePieces pieces{result.run.residual, Eigen::MatrixXd(result.run.residual.size(), 0), 0};
  for (const Accepted& accepted : result.accepted) {
    const bool is_wave = IsHardlySeen(accepted.family.effect, OrderOf(accepted), context);
    if (!is_wave && !(IsPiece(accepted) && accepted.family.effect == "scale")) {
      pieces.rows -= accepted.columns * accepted.amplitudes;
      continue;
    }
    const Eigen::MatrixXd columns = is_wave ? model::Wave(OrderOf(accepted) * context.device_rad) : PowersOf(context.device_rad, NumbersOf(accepted));
    pieces.columns.conservativeResize(Eigen::NoChange, pieces.columns.cols() + columns.cols());
    pieces.columns.rightCols(columns.cols()) = columns;
    pieces.numbers += columns.cols() + (is_wave ? 1 : 0);
  }
  return pieces;
}

/// The least degree of a polynomial that does as well as the pieces; 0 if none does.
Eigen::Index DegreeLike(const CurvePieces& pieces, const SignalContext& context, const LinearRun& run) {
  constexpr double kStrongly = 6.0;  // Kass and Raftery, Bayes factors (1995)
  const ColumnsFit by_pieces = FitTo(pieces.rows, run, pieces.columns);
  const double readings = static_cast<double>(pieces.rows.size()) / MemoryOf(by_pieces.white_left, run.schedule.pass);
  for (Eigen::Index degree = 2; degree <= pieces.numbers; ++degree) {
    const double left = FitTo(pieces.rows, run, PowersOf(context.device_rad, degree)).left;
    const double numbers = static_cast<double>(degree - pieces.numbers) * std::log(std::max(readings, 1.0));
    if (readings * std::log(left / by_pieces.left) + numbers < kStrongly) return degree;
  }
  return 0;
}

}  // namespace

void TellOrCurve(const SignalContext& context, DiagnosisRun& result) {
  const auto is_hardly_seen = [&](const Accepted& accepted) { return IsHardlySeen(accepted.family.effect, OrderOf(accepted), context); };
  if (std::ranges::none_of(result.accepted, is_hardly_seen)) return;
  const Eigen::Index degree = DegreeLike(PiecesOf(context, result), context, result.run);
  if (degree == 0) return;
  for (Cause& cause : result.diagnosis.causes) {
    const auto order = std::ranges::find(cause.parameters, "order", &ParameterEstimate::name);
    if (order == cause.parameters.end() || !IsHardlySeen(cause.effect, order->value, context)) continue;
    cause.probability = std::min(cause.probability, tuning::kNotProven);
    cause.next_measurement = "more of the turn, over which an order repeats and a curve does not";
    const double periods = order->value * RangeOfSetUp_rad(context) / units::turn;
    result.diagnosis.notes.push_back(fmt::format(
        "order {:.4g} goes through {:.2g} periods here: a curve of degree {} does as well, and so may orders near it", order->value, periods, degree));
  }
}

}  // namespace twinbench::diagnose::encoder
