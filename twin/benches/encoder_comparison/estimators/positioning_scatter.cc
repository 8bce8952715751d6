#include "twin/benches/encoder_comparison/estimators/positioning_scatter.h"

#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <tuple>

#include "twin/core/last_answer.h"
#include "twin/core/stream.h"

namespace twinbench::measure {
namespace {

using Eigen::ArrayXd;

Side SideOf(const std::vector<TargetPositioning>& targets, ApproachPositioning TargetPositioning::*approach) {
  const Eigen::Index size = std::ssize(targets);
  Side side{ArrayXd(size), ArrayXd(size), ArrayXd(size), ArrayXd(size)};
  for (Eigen::Index i = 0; i < size; ++i) {
    const ApproachPositioning& a = targets[static_cast<std::size_t>(i)].*approach;
    side.runs[i] = a.runs;
    side.mean[i] = a.mean;
    side.deviation[i] = a.deviation;
    side.rounding[i] = a.rounding;
  }
  return side;
}

/// Of one side of one target: root of chi-squared over its degrees of freedom, and a normal variable.
struct Draw {
  double spread, shift;
};

Draw DrawOf(double runs, Stream& stream) {
  const double freedom = runs - 1.0;
  const double chi_squared = freedom > 0.0 ? stream.ChiSquared(freedom) : kNaN;
  return {std::sqrt(chi_squared / freedom), stream.Normal()};
}

using Draws = std::vector<Draw>;  // replica by replica, in each forward before backward

void AddReplica(const std::vector<double>& runs, Stream& stream, Draws& draws) {
  for (const double of_target : runs) draws.push_back(DrawOf(of_target, stream));
}

/// Draws go by the numbers of runs alone: a trial of a campaign has those of the trial before.
std::shared_ptr<const Draws> SharedDraws(const PositioningBootstrap& bootstrap, const std::string& name, const std::vector<double>& runs) {
  using Question = std::tuple<std::uint64_t, int, std::vector<double>>;
  static std::map<std::string, LastAnswer<Question, Draws>> by_name;
  static std::mutex mutex;
  const std::unique_lock lock(mutex);
  return by_name[name].To(Question(bootstrap.seed, bootstrap.replicas, runs), [&] {
    Stream stream(bootstrap.seed, name);
    Draws draws;
    for (int k = 0; k < bootstrap.replicas; ++k) AddReplica(runs, stream, draws);
    return draws;
  });
}

/// What the same number of runs could have given: mean normal, variance chi-squared. What rounding hides is scattered too.
class Replicas {
 public:
  explicit Replicas(const Side& side) : side_(side), again_(side), u_mean_(side.mean.size()), hidden_(u_mean_) {
    for (Eigen::Index i = 0; i < side.mean.size(); ++i) {
      u_mean_[i] = std::hypot(side.deviation[i] / std::sqrt(side.runs[i]), side.rounding[i]);
      hidden_[i] = std::hypot(side.deviation[i], side.rounding[i]) - side.deviation[i];
    }
  }
  const Side& Again(const Draw* draw) {
    for (Eigen::Index i = 0; i < side_.mean.size(); ++i) {
      again_.mean[i] = side_.mean[i] + u_mean_[i] * draw[i].shift;
      again_.deviation[i] = std::abs((side_.deviation[i] + hidden_[i]) * draw[i].spread - hidden_[i]);
    }
    return again_;
  }

 private:
  const Side& side_;
  Side again_;
  ArrayXd u_mean_, hidden_;
};

}  // namespace

std::vector<ScatteredValue> WithScatter(const std::vector<TargetPositioning>& targets, const AxisFigures& figures,
                                        const PositioningBootstrap& bootstrap, const std::string& name) {
  const Side f = SideOf(targets, &TargetPositioning::forward), b = SideOf(targets, &TargetPositioning::backward);
  const ArrayXd values = figures(f, b);
  std::vector<double> runs(f.runs.begin(), f.runs.end());
  runs.insert(runs.end(), b.runs.begin(), b.runs.end());
  constexpr std::size_t kMostShared = 1 << 20;  // 16 MB
  // Of very many targets u is known to 7 % at least.
  constexpr int kMostDraws = 1 << 21, kFewestReplicas = 100;
  const int affordable = std::max(kFewestReplicas, kMostDraws / std::max(1, static_cast<int>(runs.size())));
  const int replicas = std::min(bootstrap.replicas, affordable);
  const bool is_shared = runs.size() * static_cast<std::size_t>(bootstrap.replicas) <= kMostShared;
  const std::shared_ptr<const Draws> shared = is_shared ? SharedDraws(bootstrap, name, runs) : nullptr;
  Stream stream(bootstrap.seed, name);
  Draws own;
  Replicas of_f(f), of_b(b);
  ArrayXd sum = ArrayXd::Zero(values.size()), squares = sum;
  for (int k = 0; k < replicas; ++k) {
    own.clear();
    if (!shared) AddReplica(runs, stream, own);
    const Draw* const draw = shared ? shared->data() + static_cast<std::size_t>(k) * runs.size() : own.data();
    const ArrayXd change = figures(of_f.Again(draw), of_b.Again(draw + f.runs.size())) - values;
    sum += change;
    squares += change.square();
  }
  const double n = replicas;
  const ArrayXd bias = sum / n, u = (squares / n - bias.square()).abs().sqrt();  // rounding may give -0
  std::vector<ScatteredValue> scattered;
  for (Eigen::Index i = 0; i < values.size(); ++i) scattered.push_back({values[i], u[i], bias[i]});
  return scattered;
}

}  // namespace twinbench::measure
