#include "twin/diagnose/engine/prior.h"

#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "twin/diagnose/tuning.h"

namespace twinbench::diagnose {

Eigen::VectorXd LogPriors(const std::vector<Family>& families) {
  std::map<std::pair<Kind, std::string>, int> members;
  for (const Family& f : families) ++members[{f.kind, f.group}];
  std::map<Kind, int> groups;
  for (const auto& group : members) ++groups[group.first.first];
  Eigen::VectorXd log_priors(std::ssize(families));
  for (std::size_t k = 0; k < families.size(); ++k) {
    const Family& f = families[k];
    const double share = f.kind == Kind::kNamed ? tuning::kPriorNamed : tuning::kPriorUnknown;
    log_priors[static_cast<Eigen::Index>(k)] =
        std::log(share * f.prior_weight / groups[f.kind] / members[{f.kind, f.group}]);
  }
  return log_priors;
}

double LogSum(const Eigen::VectorXd& logs) {
  const double top = logs.maxCoeff();
  return top + std::log((logs.array() - top).exp().sum());
}

Eigen::VectorXd AlarmStatistic(const Eigen::MatrixXd& log_bayes, const Eigen::VectorXd& log_priors) {
  Eigen::VectorXd statistic(log_bayes.cols());
  for (Eigen::Index k = 0; k < log_bayes.cols(); ++k) {
    statistic[k] = LogSum(log_bayes.col(k) + log_priors) - std::log(tuning::kPriorNone);
  }
  return statistic;
}

}  // namespace twinbench::diagnose
