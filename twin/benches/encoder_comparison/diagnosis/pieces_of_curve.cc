#include "twin/benches/encoder_comparison/diagnosis/pieces_of_curve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/benches/encoder_comparison/diagnosis/target_curve.h"
#include "twin/core/units.h"
#include "twin/diagnose/tuning.h"
#include "twin/diagnose/unknown/collector.h"

namespace twinbench::diagnose::encoder {
namespace {

constexpr const char* kPiece = "periodic";

bool IsPieceOfCurve(const Accepted& accepted) {
  return accepted.family.effect == kPiece && accepted.family.kind == Kind::kNamed;
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
    if (cause.effect != kPiece || !std::isfinite(order + amplitude + phase_rad)) continue;
    waves.push_back(
        {unknown::SignalOf("harmonic", "device", {{"order", order}, {"phase", phase_rad}}), 0, false, amplitude});
  }
  return waves;
}

Accepted CurveOf(const std::vector<Accepted>& accepted, const std::vector<Cause>& causes, Eigen::Index rows) {
  Accepted curve = ErrorCurve(Eigen::VectorXd::Zero(rows));
  for (const Accepted& a : accepted) {
    if (IsPieceOfCurve(a)) curve.columns += a.columns * a.amplitudes;
  }
  curve.family.products = [waves = WavesOf(causes)](const Eigen::VectorXd&, int) { return waves; };
  return curve;
}

double PowerOfCurve(const Eigen::VectorXd& rows) {
  return (rows.array() - rows.mean()).matrix().squaredNorm();
}

/// No sum of waves meets a curve: what is this small beside it may be no more than what they leave of it.
void DoubtCrumbs(double power, DiagnosisRun& result) {
  for (const Accepted& accepted : result.accepted) {
    if (accepted.family.kind != Kind::kNamed ||
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
  constexpr std::ptrdiff_t kMany = 6;
  const LinearRun& run = result.run;
  const auto pieces = std::ranges::count_if(result.accepted, IsPieceOfCurve);
  if (pieces < kMany || run.schedule.reference_rad.maxCoeff() - run.schedule.reference_rad.minCoeff() > kPart)
    return;
  Diagnosis& d = result.diagnosis;
  Accepted curve = CurveOf(result.accepted, d.causes, run.Rows());
  const double power = PowerOfCurve(curve.columns.col(0));
  std::erase_if(result.accepted, IsPieceOfCurve);
  DoubtCrumbs(power, result);
  std::erase_if(d.causes, [](const Cause& cause) { return cause.effect == kPiece; });
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
