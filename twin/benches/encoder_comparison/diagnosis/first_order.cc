#include "twin/benches/encoder_comparison/diagnosis/first_order.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>

#include "twin/benches/encoder_comparison/diagnosis/families.h"
#include "twin/benches/encoder_comparison/diagnosis/twin_fit.h"
#include "twin/core/linear_algebra.h"
#include "twin/core/units.h"
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
struct WaveFit {
  Eigen::VectorXd sizes;
  double left = 0.0;
};

WaveFit FitTo(const Eigen::VectorXd& rows, const LinearRun& run, const Eigen::MatrixXd& columns) {
  Eigen::MatrixXd all(rows.size(), columns.cols() + run.nuisance.jacobian.cols());
  all << columns, run.nuisance.jacobian.toDense();
  const Eigen::VectorXd weight = run.sigma.cwiseInverse();
  const Eigen::MatrixXd white = weight.asDiagonal() * all;
  const Eigen::VectorXd data = weight.cwiseProduct(rows);
  const Eigen::VectorXd sizes = SolveShortest(white, data);
  return {sizes.head(columns.cols()), (data - white * sizes).squaredNorm()};
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
  const WaveFit by_pieces = FitTo(rows - pieces, run, Eigen::MatrixXd(rows.size(), 0)), by_order = FitTo(rows, run, model::Wave(context.device_rad));
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

}  // namespace twinbench::diagnose::encoder
