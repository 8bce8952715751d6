#include "twin/uncertainty/monte_carlo.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <thread>

#include "twin/core/scenario_uncertainty.h"
#include "twin/core/stream.h"

namespace twinbench::uncertainty {
namespace {

constexpr int kBlock = 250;  // trials; their spread from block to block tells when to stop
constexpr double kProbability = 0.95;

/// A standard deviation of one, of this shape.
double Drawn(const StatedUncertainty& stated, Stream& stream) {
  switch (stated.distribution) {
    case Distribution::kUniform:
      return std::sqrt(3.0) * (2.0 * stream.Uniform() - 1.0);
    case Distribution::kTriangular: {
      const double a = stream.Uniform();
      return std::sqrt(6.0) * (a + stream.Uniform() - 1.0);
    }
    case Distribution::kNormal:
      break;
  }
  const double normal = stream.Normal();
  return std::isfinite(stated.dof) ? normal / std::sqrt(stream.ChiSquared(stated.dof) / stated.dof) : normal;
}

Stream StreamOf(std::uint64_t seed, const std::string& name, std::int64_t trial) {
  Stream stream(seed, "uncertainty." + name);
  stream.Seek(static_cast<std::uint64_t>(trial) << 8);
  return stream;
}

/// One trial's values, in the order of `quantities`; what could not be evaluated is NaN.
std::vector<double> Trial(const Scenario& scenario, const Evaluate& evaluate,
                          const std::vector<Quantity>& quantities, std::uint64_t seed, int trial) {
  std::map<std::string, double> drawn;
  for (const Quantity& q : evaluate(DrawnScenario(scenario, seed, trial))) drawn[q.name] = q.value;
  Stream stream = StreamOf(seed, "readings", trial);
  std::vector<double> values;
  for (const Quantity& q : quantities) {
    const auto found = drawn.find(q.name);
    const double own = Drawn({"", 1.0, Distribution::kNormal, q.dof}, stream);
    values.push_back(found == drawn.end() ? std::nan("") : found->second + q.u * own);
  }
  return values;
}

/// Trials [begin, begin + kBlock), shared among threads.
void AddBlock(const Scenario& scenario, const Evaluate& evaluate, const std::vector<Quantity>& quantities,
              const MonteCarloOptions& options, std::vector<std::vector<double>>& trials) {
  const int begin = static_cast<int>(trials.size());
  trials.resize(trials.size() + kBlock);
  std::atomic<int> next = begin;
  const auto work = [&] {
    for (int trial = next++; trial < begin + kBlock; trial = next++)
      trials[static_cast<std::size_t>(trial)] = Trial(scenario, evaluate, quantities, options.seed, trial);
  };
  std::vector<std::jthread> others;
  for (int k = 1; k < options.threads; ++k) others.emplace_back(work);
  work();
}

double MeanOf(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

double DeviationOf(const std::vector<double>& values) {
  const double mean = MeanOf(values);
  double squares = 0.0;
  for (const double v : values) squares += (v - mean) * (v - mean);
  return std::sqrt(squares / static_cast<double>(values.size() - 1));
}

/// Half of one in the last of so many digits of `u` (JCGM 101, 7.9.2).
double Tolerance(double u, int digits) {
  return 0.5 * std::pow(10.0, std::floor(std::log10(u)) - (digits - 1));
}

/// Whether the standard deviation no longer moves between blocks by more than its digits allow.
bool IsSettled(const std::vector<double>& values, int digits) {
  const std::size_t blocks = values.size() / kBlock;
  if (blocks < 4) return false;
  std::vector<double> deviations;
  for (std::size_t b = 0; b < blocks; ++b) {
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(b * kBlock);
    deviations.push_back(DeviationOf({begin, begin + kBlock}));
  }
  const double u = DeviationOf(values);
  return !(u > 0.0) ||
         2.0 * DeviationOf(deviations) / std::sqrt(static_cast<double>(blocks)) < Tolerance(u, digits);
}

Spread SpreadOf(const Quantity& quantity, std::vector<double> values) {
  Spread spread{quantity, MeanOf(values), DeviationOf(values)};
  std::ranges::sort(values);
  const auto n = values.size();
  const auto inside = static_cast<std::size_t>(kProbability * static_cast<double>(n));
  const std::size_t left = (n - inside) / 2;
  spread.symmetric = {values[left], values[left + inside - 1]};
  std::size_t best = 0;
  for (std::size_t i = 0; i + inside <= n; ++i) {
    if (values[i + inside - 1] - values[i] < values[best + inside - 1] - values[best]) best = i;
  }
  spread.shortest = {values[best], values[best + inside - 1]};
  return spread;
}

std::vector<double> ColumnOf(const std::vector<std::vector<double>>& trials, std::size_t quantity) {
  std::vector<double> values;
  for (const std::vector<double>& trial : trials) {
    if (std::isfinite(trial[quantity])) values.push_back(trial[quantity]);
  }
  return values;
}

}  // namespace

Scenario DrawnScenario(Scenario scenario, std::uint64_t seed, std::int64_t trial) {
  for (const StatedUncertainty& stated : scenario.uncertainties) {
    Stream stream = StreamOf(seed, stated.key, trial);
    for (double& number : NumbersAt(scenario, stated.key)) number += stated.u * Drawn(stated, stream);
  }
  return scenario;
}

MonteCarlo Propagate(const Scenario& scenario, const Evaluate& evaluate, const MonteCarloOptions& options) {
  const std::vector<Quantity> quantities = evaluate(scenario);
  std::vector<std::vector<double>> trials;
  MonteCarlo result;
  while (!result.settled && static_cast<int>(trials.size()) + kBlock <= options.most_trials) {
    AddBlock(scenario, evaluate, quantities, options, trials);
    result.settled = true;
    for (std::size_t i = 0; i < quantities.size() && result.settled; ++i)
      result.settled = IsSettled(ColumnOf(trials, i), options.digits);
  }
  result.trials = static_cast<int>(trials.size());
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    std::vector<double> values = ColumnOf(trials, i);
    if (values.size() > 1) result.spreads.push_back(SpreadOf(quantities[i], std::move(values)));
  }
  return result;
}

}  // namespace twinbench::uncertainty
