#include "twin/diagnose/joint_design.h"

#include <algorithm>
#include <cmath>

#include "twin/core/linear_algebra.h"
#include "twin/diagnose/words.h"

namespace twinbench::diagnose {
namespace {

/// The run's number of the same cause; -1: it has none.
Eigen::Index IndexIn(const Isolability& run, const ShownCause& cause) {
  const auto found = std::ranges::find_if(run.causes, [&cause](const ShownCause& other) {
    return other.effect == cause.effect && other.where == cause.where;
  });
  return found == run.causes.end() ? -1 : found - run.causes.begin();
}

bool IsNeverTold(const Isolability& run, std::size_t present, std::size_t blamed) {
  return std::ranges::any_of(run.confusable, [&](const Confusable& pair) {
    return pair.present == present && pair.blamed == blamed && !std::isfinite(pair.told_from);
  });
}

bool IsFound(const Isolability& run, Eigen::Index cause) {
  return cause >= 0 && std::isfinite(run.causes[static_cast<std::size_t>(cause)].smallest.value);
}

std::string PlaceOfCause(const ShownCause& cause) {
  return Place(cause.effect, cause.where);
}

}  // namespace

Eigen::MatrixXd InformationInOrder(const Isolability& run, const Isolability& order) {
  const auto count = std::ssize(order.causes);
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(count, count);
  std::vector<Eigen::Index> of;
  std::vector<double> scale;  // one plausible size of `order` in those of the run
  for (const ShownCause& cause : order.causes) {
    of.push_back(IndexIn(run, cause));
    scale.push_back(of.back() < 0 ? 0.0
                                  : cause.plausible_SI / run.causes[static_cast<std::size_t>(of.back())].plausible_SI);
  }
  for (Eigen::Index k = 0; k < count; ++k) {
    for (Eigen::Index l = 0; l < count; ++l) {
      const auto i = of[static_cast<std::size_t>(k)], j = of[static_cast<std::size_t>(l)];
      if (i < 0 || j < 0) continue;
      information(k, l) =
          scale[static_cast<std::size_t>(k)] * scale[static_cast<std::size_t>(l)] * run.information(i, j);
    }
  }
  return 0.5 * (information + information.transpose());
}

double ClosestCauses(const Eigen::MatrixXd& information) {
  constexpr double kShown = 1e-9;
  double closest2 = kNaN;
  for (Eigen::Index k = 0; k < information.rows(); ++k) {
    for (Eigen::Index l = 0; l < information.rows(); ++l) {
      if (k == l || information(k, k) < kShown || information(l, l) < kShown) continue;
      const double left =
          std::max(0.0, information(k, k) - information(k, l) * information(k, l) / information(l, l));
      if (!(closest2 <= left)) closest2 = left;
    }
  }
  return std::sqrt(closest2);
}

double InformationGain_bit(const Eigen::MatrixXd& information) {
  const Eigen::VectorXd values = EigenvaluesOfSymmetric(information);
  return 0.5 * values.cwiseMax(0.0).array().log1p().sum() / std::log(2.0);
}

std::vector<std::string> BrokenTies(const Isolability& before, const Isolability& after) {
  std::vector<std::string> broken;
  for (const Confusable& pair : before.confusable) {
    if (std::isfinite(pair.told_from)) continue;
    const ShownCause &present = before.causes[pair.present], &blamed = before.causes[pair.blamed];
    const Eigen::Index a = IndexIn(after, present), b = IndexIn(after, blamed);
    if (!IsFound(after, a) || b < 0 || IsNeverTold(after, static_cast<std::size_t>(a), static_cast<std::size_t>(b)))
      continue;
    std::string names[2] = {PlaceOfCause(present), PlaceOfCause(blamed)};
    std::ranges::sort(names);
    const std::string both = names[0] + " | " + names[1];
    if (std::ranges::count(broken, both) == 0) broken.push_back(both);
  }
  return broken;
}

std::vector<std::string> NewlyShown(const Isolability& before, const Isolability& after) {
  std::vector<std::string> shown;
  for (const ShownCause& cause : after.causes) {
    const bool is_new = std::isfinite(cause.smallest.value) && !IsFound(before, IndexIn(before, cause));
    if (is_new) shown.push_back(PlaceOfCause(cause));
  }
  return shown;
}

}  // namespace twinbench::diagnose
