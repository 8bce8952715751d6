#include "twin/benches/encoder_comparison/diagnosis/told.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "twin/benches/encoder_comparison/diagnosis/target_curve.h"
#include "twin/core/units.h"
#include "twin/diagnose/tuning.h"
#include "twin/diagnose/unknown/collector.h"

namespace twinbench::diagnose::encoder {
namespace {

constexpr const char* kPiece = "periodic";

bool IsPeriodic(const Accepted& accepted) {
  return accepted.family.effect == kPiece && accepted.family.kind == Kind::kNamed && accepted.shape.size() == 1;
}

double PowerOfCurve(const Eigen::VectorXd& rows) {
  return (rows.array() - rows.mean()).matrix().squaredNorm();
}

/// Orders of waves that repeat many times and have none like them near: those of a worm. The others together are
/// one curve.
/// @param part_rad  Of a turn, that was gone through.
std::vector<double> OrdersAlone(const std::vector<Accepted>& accepted, double part_rad) {
  constexpr double kPeriods = 10.0, kNear = 1.5, kMuchLess = 0.1;  // of orders a ratio, of power
  std::vector<double> orders;
  for (const Accepted& a : accepted) {
    if (!IsPeriodic(a) || a.shape[0] * part_rad < kPeriods * units::turn) continue;
    const double power = PowerOfCurve(a.columns * a.amplitudes);
    const auto is_like = [&](const Accepted& b) {
      return IsPeriodic(b) && b.shape[0] != a.shape[0] &&
             std::max(b.shape[0] / a.shape[0], a.shape[0] / b.shape[0]) < kNear &&
             PowerOfCurve(b.columns * b.amplitudes) > kMuchLess * power;
    };
    if (std::ranges::none_of(accepted, is_like)) orders.push_back(a.shape[0]);
  }
  return orders;
}

double Told(const Cause& cause, const char* parameter) {
  const auto found = std::ranges::find(cause.parameters, parameter, &ParameterEstimate::name);
  return found == cause.parameters.end() ? kNaN : found->value;
}

/// As the waves that the twin can carry out.
std::vector<Product> WavesOf(const std::vector<Cause>& causes) {
  std::vector<Product> waves;
  for (const Cause& cause : causes) {
    const double order = Told(cause, "order"), amplitude = Told(cause, "amplitude"),
                 phase_rad = Told(cause, "phase");
    if (!std::isfinite(order + amplitude + phase_rad)) continue;
    waves.push_back(
        {unknown::SignalOf("harmonic", "device", {{"order", order}, {"phase", phase_rad}}), 0, false, amplitude});
  }
  return waves;
}

Accepted CurveOf(const std::vector<Accepted>& pieces, const std::vector<Cause>& causes, Eigen::Index rows) {
  Accepted curve = ErrorCurve(Eigen::VectorXd::Zero(rows));
  for (const Accepted& a : pieces) curve.columns += a.columns * a.amplitudes;
  curve.family.products = [waves = WavesOf(causes)](const Eigen::VectorXd&, int) { return waves; };
  return curve;
}

/// No sum of waves meets a curve: what is this small beside it may be no more than what they leave of it.
void DoubtCrumbs(double power, DiagnosisRun& result) {
  for (const Accepted& accepted : result.accepted) {
    if (accepted.family.kind != Kind::kNamed || accepted.family.effect == kPiece ||
        PowerOfCurve(accepted.columns * accepted.amplitudes) > tuning::kSmallRest * power)
      continue;
    for (Cause& cause : result.diagnosis.causes) {
      if (cause.effect == accepted.family.effect)
        cause.probability = std::min(cause.probability, 1.0 - tuning::kListed);
    }
  }
}

}  // namespace

void TellCurveInPieces(DiagnosisRun& result) {
  constexpr double kPart = 0.5 * units::turn;
  constexpr std::size_t kMany = 6;
  const LinearRun& run = result.run;
  const double part_rad = run.schedule.reference_rad.maxCoeff() - run.schedule.reference_rad.minCoeff();
  const std::vector<double> alone = OrdersAlone(result.accepted, part_rad);
  const auto is_piece = [&](const Accepted& a) {
    return IsPeriodic(a) && std::ranges::count(alone, a.shape[0]) == 0;
  };
  const auto is_told = [&](const Cause& cause) {
    return cause.effect == kPiece && std::ranges::count(alone, Told(cause, "order")) == 0;
  };
  std::vector<Accepted> pieces;
  std::ranges::copy_if(result.accepted, std::back_inserter(pieces), is_piece);
  if (pieces.size() < kMany || part_rad > kPart) return;
  Diagnosis& d = result.diagnosis;
  std::vector<Cause> told;
  std::ranges::copy_if(d.causes, std::back_inserter(told), is_told);
  Accepted curve = CurveOf(pieces, told, run.Rows());
  const double power = PowerOfCurve(curve.columns.col(0));
  std::erase_if(result.accepted, is_piece);
  DoubtCrumbs(power, result);
  std::erase_if(d.causes, is_told);
  double others = 0.0;
  for (const Accepted& accepted : result.accepted) {
    if (accepted.family.kind == Kind::kNamed) others += PowerOfCurve(accepted.columns * accepted.amplitudes);
  }
  result.accepted.insert(result.accepted.begin(), std::move(curve));
  const double amplitude = std::sqrt(2.0 * power / static_cast<double>(run.Rows())) / run.to_SI;
  const std::string words = fmt::format(
      "error curve over a part of a turn, the same in both directions, synchronous with reference angle, on angle, "
      "amplitude {:.2g} {}",
      amplitude, run.unit);
  d.unknown.signature = words + (d.unknown.signature.empty() ? "" : " | " + d.unknown.signature);
  d.unknown.probability = std::max(d.unknown.probability, tuning::kListed);
  if (d.causes.empty() || power > others) d.verdict = Verdict::kUnknown;
}

}  // namespace twinbench::diagnose::encoder
