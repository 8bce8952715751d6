#include "twin/benches/encoder_comparison/diagnosis/told.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "twin/benches/encoder_comparison/diagnosis/large_cause.h"
#include "twin/diagnose/tuning.h"

namespace twinbench::diagnose::encoder {
namespace {

bool IsLeadingLoop(const Cause& cause) {
  const auto is_negative_size = [](const ParameterEstimate& p) { return (p.name == "width" || p.name == "lag") && p.value < 0.0; };
  return IsLoop(cause.effect) && std::ranges::any_of(cause.parameters, is_negative_size);
}

/// The most by which rows of a set-up differ at nearly equal angles.
double MostApart(const EncoderRun& encoder, const Eigen::VectorXd& rows) {
  constexpr double kParts = 200.0;  // of the range of angles
  const SignalContext& c = encoder.context;
  const double least_rad = c.reference_rad.minCoeff(), range_rad = c.reference_rad.maxCoeff() - least_rad;
  std::map<std::pair<int, int>, std::pair<double, double>> ends;  // by set-up and part
  double most = 0.0;
  for (Eigen::Index i = 0; i < rows.size(); ++i) {
    const int part = range_rad > 0.0 ? static_cast<int>(kParts * (c.reference_rad[i] - least_rad) / range_rad) : 0;
    const std::pair<int, int> place{c.setup[static_cast<std::size_t>(i)], part};
    auto& [lower, upper] = ends.try_emplace(place, rows[i], rows[i]).first->second;
    lower = std::min(lower, rows[i]);
    upper = std::max(upper, rows[i]);
    most = std::max(most, upper - lower);
  }
  return most;
}

bool IsWiderThanErrors(const EncoderRun& encoder, const std::string& effect, const DiagnosisRun& result) {
  constexpr double kWider = 1.1;
  const double most = kWider * MostApart(encoder, result.run.residual);
  return std::ranges::any_of(result.accepted, [&](const Accepted& accepted) {
    return accepted.family.effect == effect && MostApart(encoder, accepted.columns * accepted.amplitudes) > most;
  });
}

}  // namespace

void DoubtLeadingLoops(const EncoderRun& encoder, DiagnosisRun& result) {
  Diagnosis& d = result.diagnosis;
  const auto is_of_motion = [](const Cause& c) { return c.effect == "latency" || c.effect == "scale"; };
  const bool is_beside = encoder.context.Moves() && std::ranges::any_of(d.causes, is_of_motion);
  for (Cause& cause : d.causes) {
    if (!IsLeadingLoop(cause) || cause.probability <= tuning::kNotProven) continue;
    if (!is_beside && !IsWiderThanErrors(encoder, cause.effect, result)) continue;
    cause.probability = tuning::kNotProven;
    d.notes.push_back(cause.effect + ": a device that goes ahead on reversal may be one whose latency or scale is not exactly that; the same "
                                     "at another speed would tell");
  }
}

}  // namespace twinbench::diagnose::encoder
