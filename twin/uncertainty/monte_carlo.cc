#include "twin/uncertainty/monte_carlo.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "twin/core/scenario_uncertainty.h"
#include "twin/core/side_by_side.h"
#include "twin/core/stream.h"
#include "twin/uncertainty/agreement.h"

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

/// Quantities of a joint by their places, and what independent numbers become them.
struct DrawnTogether {
  std::vector<std::size_t> places;
  Eigen::MatrixXd root;
  double dof = std::numeric_limits<double>::infinity();
};

/// What stays the same from trial to trial.
struct Trials {
  const Scenario& scenario;
  const Evaluate& evaluate;
  const MonteCarloOptions& options;
  std::vector<Quantity> quantities;
  std::vector<DrawnTogether> together;
};

std::vector<std::string> NamesOf(const std::vector<Quantity>& quantities) {
  std::vector<std::string> names;
  for (const Quantity& q : quantities) names.push_back(q.name);
  return names;
}

DrawnTogether TogetherOf(const Joint& joint, const std::vector<Quantity>& quantities) {
  DrawnTogether drawn{{}, RootOf(joint.cov)};
  for (const std::string& name : joint.names) {
    const auto q = std::ranges::find(quantities, name, &Quantity::name);
    drawn.places.push_back(static_cast<std::size_t>(q - quantities.begin()));
    drawn.dof = std::min(drawn.dof, q->dof);
  }
  return drawn;
}

/// One standard deviation's length of Student's distribution over that of the normal one.
double TailOf(double dof, Stream& stream) {
  return std::isfinite(dof) ? std::sqrt(dof / stream.ChiSquared(dof)) : 1.0;
}

/// What the readings might have done to every quantity.
std::vector<double> OfReadingsDrawn(const Trials& trials, Stream& stream) {
  std::vector<double> change;
  for (const Quantity& q : trials.quantities)
    change.push_back(q.u * Drawn({"", 1.0, Distribution::kNormal, q.dof}, stream));
  for (const DrawnTogether& together : trials.together) {
    Eigen::VectorXd normal(together.root.cols());
    for (double& x : normal) x = stream.Normal();
    const Eigen::VectorXd drawn = TailOf(together.dof, stream) * (together.root * normal);
    for (std::size_t i = 0; i < together.places.size(); ++i)
      change[together.places[i]] = drawn[static_cast<Eigen::Index>(i)];
  }
  return change;
}

/// One trial's values, in the order of the quantities; what could not be evaluated is NaN.
std::vector<double> Trial(const Trials& trials, int trial) {
  std::map<std::string, double> drawn;
  for (const Quantity& q : trials.evaluate(DrawnScenario(trials.scenario, trials.options.seed, trial)))
    drawn[q.name] = q.value;
  Stream stream = StreamOf(trials.options.seed, "readings", trial);
  std::vector<double> values = OfReadingsDrawn(trials, stream);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto found = drawn.find(trials.quantities[i].name);
    values[i] += found == drawn.end() ? std::nan("") : found->second;
  }
  return values;
}

/// Trials [begin, begin + kBlock), shared among threads.
void AddBlock(const Trials& of, std::vector<std::vector<double>>& trials) {
  const int begin = static_cast<int>(trials.size());
  trials.resize(trials.size() + kBlock);
  SideBySide(kBlock, of.options.threads, [&](int k) { trials[static_cast<std::size_t>(begin + k)] = Trial(of, begin + k); });
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
         2.0 * DeviationOf(deviations) / std::sqrt(static_cast<double>(blocks)) < NumericalTolerance(u, digits);
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

/// Of the quantities of a joint that every trial could evaluate.
JointSpread TogetherFrom(const Joint& joint, const DrawnTogether& drawn,
                         const std::vector<std::vector<double>>& trials) {
  Joint whole{joint.name, {}, {}};
  Eigen::MatrixXd values(std::ssize(trials), std::ssize(drawn.places));
  Eigen::Index kept = 0;
  for (std::size_t i = 0; i < drawn.places.size(); ++i) {
    for (std::size_t t = 0; t < trials.size(); ++t)
      values(static_cast<Eigen::Index>(t), kept) = trials[t][drawn.places[i]];
    if (!values.col(kept).allFinite()) continue;
    whole.names.push_back(joint.names[i]);
    ++kept;
  }
  return SpreadOfTrials(whole, values.leftCols(kept));
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
  Trials of{scenario, evaluate, options, evaluate(scenario), {}};
  std::vector<Joint> joints;
  for (const Joint& joint : options.joints) {
    joints.push_back(Determined(joint, NamesOf(of.quantities)));
    of.together.push_back(TogetherOf(joints.back(), of.quantities));
  }
  std::vector<std::vector<double>> trials;
  MonteCarlo result;
  while (!result.settled && static_cast<int>(trials.size()) + kBlock <= options.most_trials) {
    AddBlock(of, trials);
    result.settled = true;
    for (std::size_t i = 0; i < of.quantities.size() && result.settled; ++i)
      result.settled = IsSettled(ColumnOf(trials, i), options.digits);
  }
  result.trials = static_cast<int>(trials.size());
  for (std::size_t i = 0; i < of.quantities.size(); ++i) {
    std::vector<double> values = ColumnOf(trials, i);
    if (values.size() > 1) result.spreads.push_back(SpreadOf(of.quantities[i], std::move(values)));
  }
  for (std::size_t j = 0; j < joints.size() && trials.size() > 1; ++j)
    result.together.push_back(TogetherFrom(joints[j], of.together[j], trials));
  return result;
}

}  // namespace twinbench::uncertainty
