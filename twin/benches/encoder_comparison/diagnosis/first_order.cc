#include "twin/benches/encoder_comparison/diagnosis/first_order.h"

#include <fmt/format.h>

#include <algorithm>

#include "twin/benches/encoder_comparison/diagnosis/families.h"
#include "twin/benches/encoder_comparison/diagnosis/twin_fit.h"
#include "twin/core/linear_algebra.h"
#include "twin/core/units.h"
#include "twin/model/signals.h"

namespace twinbench::diagnose::encoder {
namespace {

constexpr double kLowOrder = 4.0;

bool IsLow(double order) {
  return order <= kLowOrder;
}

bool IsPiece(const Accepted& accepted) {
  if (accepted.family.kind != Kind::kNamed) return false;
  const std::string& effect = accepted.family.effect;
  return effect == "scale" || effect == "ellipticity" || (effect == "periodic" && accepted.shape.size() == 1 && IsLow(accepted.shape[0]));
}

bool IsPiece(const Cause& cause) {
  const auto order = std::ranges::find(cause.parameters, "order", &ParameterEstimate::name);
  const bool is_low = order != cause.parameters.end() && IsLow(order->value);
  return cause.effect == "scale" || cause.effect == "ellipticity" || (cause.effect == "periodic" && is_low);
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
