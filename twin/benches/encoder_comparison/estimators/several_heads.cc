#include "twin/benches/encoder_comparison/estimators/several_heads.h"

#include <algorithm>
#include <cmath>

#include "twin/benches/encoder_comparison/estimators/head_fit.h"
#include "twin/benches/encoder_comparison/estimators/method_distance.h"

namespace twinbench::separate::encoder {
namespace {

/// The mean of all heads is taken for the shaft, as if the ring had no error.
HeadSolution WithMeanOfHeads(HeadSolution solution) {
  solution.x.setZero();
  return solution;
}

}  // namespace

double Likeness(const std::vector<double>& heads_rad, int order) {
  harmonics::Complex sum = 0.0;
  for (const double head_rad : heads_rad) sum += std::polar(1.0, -order * head_rad);
  return std::norm(sum) / static_cast<double>(heads_rad.size() * heads_rad.size());
}

SeveralHeads SeparateHeads(const std::vector<Reading>& readings, const HeadOptions& options) {
  const HeadReadings sorted = SortHeads(readings);
  SeveralHeads result = BeginHeads(sorted, options);
  if (!result.not_separated.empty()) return result;
  const OrdersToFit orders = OrdersOf(sorted, result.Highest(), result.lost.orders);
  HeadEquations equations(orders);
  for (const HeadStop& stop : sorted.stops) equations.AddStop(stop);
  HeadSolution solution = equations.Solve();
  AddRounding(sorted, orders, StopRows::kAllHeads, WithOwnStep(options.steps, readings), solution);
  EnterCurve(solution, orders, result);
  EnterReference(sorted, solution, orders, result);
  result.ring_by_noise = result.ring;
  AddUnresolved(sorted, orders, StopRows::kAllHeads, solution, WithOwnStep(options.steps, readings).step_rad,
                result.ring);
  return result;
}

SeveralHeads EqualDivision(const std::vector<Reading>& readings, const HeadOptions& options) {
  const HeadReadings sorted = SortHeads(readings);
  SeveralHeads result = BeginHeads(sorted, options);
  if (!result.not_separated.empty()) return result;
  const int heads = static_cast<int>(sorted.heads_rad.size());
  result.lost.orders.clear();
  for (int order = heads; order <= result.Highest(); order += heads) result.lost.orders.push_back(order);
  const OrdersToFit orders = OrdersOf(sorted, result.Highest(), result.lost.orders);
  HeadEquations equations(orders);
  for (const HeadStop& stop : sorted.stops) {
    if (std::ssize(stop.values) == heads) equations.AddFirstAgainstMean(stop);
  }
  HeadSolution solution = equations.Solve();
  if (solution.dof < 1.0) {
    result.not_separated = "too few instants at which all heads were read";
    return result;
  }
  AddRounding(sorted, orders, StopRows::kFirstAgainstMean, WithOwnStep(options.steps, readings), solution);
  EnterCurve(solution, orders, result);
  result.residual_rms_rad *= std::sqrt(heads / (heads - 1.0));  // of the difference: one head less 1 / N of itself
  EnterReference(sorted, WithMeanOfHeads(solution), orders, result);
  result.ring_by_noise = result.ring;
  AddUnresolved(sorted, orders, StopRows::kFirstAgainstMean, solution,
                WithOwnStep(options.steps, readings).step_rad, result.ring);
  const std::string biased = WidenByDistance(SeparateHeads(readings, options).ring, result.ring);
  if (!biased.empty()) result.notes.push_back(BiasNote(biased));
  return result;
}

}  // namespace twinbench::separate::encoder
