#include "twin/benches/hob_transmission/told_orders.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "twin/core/distributions.h"
#include "twin/core/rounding.h"

namespace twinbench::benches::hob {
namespace {

/// The step of an angle that was read; 0 where that is no more than the distance of even rows.
double StepOf_rad(const std::vector<Reading>& readings, double Reading::*angle_rad) {
  constexpr double kOfRows = 0.25;
  std::vector<double> shown_rad, ways_rad;
  for (const Reading& r : readings) {
    if (std::isfinite(r.*angle_rad)) shown_rad.push_back(r.*angle_rad);
  }
  for (std::size_t i = 1; i < shown_rad.size(); ++i) ways_rad.push_back(std::abs(shown_rad[i] - shown_rad[i - 1]));
  if (ways_rad.empty()) return 0.0;
  const double step_rad = CommonStep(Eigen::Map<const Eigen::VectorXd>(shown_rad.data(), std::ssize(shown_rad)));
  return step_rad < kOfRows * Median(std::move(ways_rad)) ? step_rad : 0.0;
}

}  // namespace

void DoubtOrdersOfRounding(const std::vector<Reading>& readings, const diagnose::LinearRun& run, double hob_order,
                           diagnose::Diagnosis& diagnosis) {
  constexpr double kEven = 0.5;  // for it and against it
  const double step_rad = std::max(StepOf_rad(readings, &Reading::measured_rad), StepOf_rad(readings, &Reading::reference_rad) / hob_order);
  const double largest_rad = std::sqrt(2.0) * LargestByRounding(step_rad, run.sigma.size() > 0 ? run.sigma.mean() : 0.0);
  bool is_any = false;
  for (diagnose::Cause& cause : diagnosis.causes) {
    const auto amplitude = std::ranges::find(cause.parameters, "amplitude", &diagnose::ParameterEstimate::name);
    const bool is_wave = cause.effect == "periodic" || cause.effect == "tone";
    if (!is_wave || amplitude == cause.parameters.end()) continue;
    if (!(std::abs(amplitude->value) < largest_rad * (cause.where == "hob" ? hob_order : 1.0))) continue;
    cause.probability = std::min(cause.probability, kEven);
    is_any = true;
  }
  if (is_any)
    diagnosis.notes.push_back("a wave that is no larger than what rounding to counts leaves may be nothing else: finer counts, or rows at uneven angles, show it");
}

}  // namespace twinbench::benches::hob
