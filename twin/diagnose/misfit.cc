#include "twin/diagnose/misfit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "twin/core/distributions.h"
#include "twin/diagnose/accepted_columns.h"

namespace twinbench::diagnose {
namespace {

constexpr double kMany = 100.0;      // times the noise
constexpr double kUnexplained = 0.5;  // of the deviation, where the causes found explain less than they leave

/// In units of the noise of each row; by the middle of the sizes, which single values do not move.
double Typical(const Eigen::VectorXd& left, const Eigen::VectorXd& sigma) {
  std::vector<double> sizes;
  for (Eigen::Index k = 0; k < left.size(); ++k) sizes.push_back(std::abs(left[k] / sigma[k]));
  return sizes.empty() ? 0.0 : Median(std::move(sizes)) / 0.6745;
}

}  // namespace

Misfit MisfitOf(const DiagnosisRun& found) {
  Misfit misfit;
  if (found.run.noise_free || !found.run.sigma_stated) return misfit;
  const LeftOver left = FitAll(found.run, found.noise, found.accepted);
  misfit.before = Typical(left.before, found.run.sigma);
  misfit.after = Typical(left.after, found.run.sigma);
  if (misfit.before < kMany) return misfit;
  misfit.is_plausible = misfit.after < kMany || misfit.after < kUnexplained * misfit.before;
  misfit.line = fmt::format("the readings differ from the scenario by {:.0f} times their noise, and by {:.0f} times "
                            "with all that was found",
                            misfit.before, misfit.after);
  if (!misfit.is_plausible) misfit.line += ": are they of this bench, this scenario and in these units?";
  return misfit;
}

}  // namespace twinbench::diagnose
