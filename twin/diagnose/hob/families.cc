#include "twin/diagnose/hob/families.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "twin/core/units.h"

namespace twinbench::diagnose::hob {
namespace {

constexpr double kPlausible_rad = 0.3 * units::arcsec;

/// Prior sizes such that each amplitude leaves a trace of `plausible_rad` rms in m (or what sees it) in the middle
/// of the grid.
void SetPriors(const SignalContext& c, double plausible_rad, Family& family) {
  const Eigen::MatrixXd columns = family.ColumnsAt(family.grid / 2);
  for (std::size_t j = 0; j < family.amplitudes.size(); ++j) {
    if (family.amplitudes[j].prior_sd != kPriorToBeSet) continue;
    const Eigen::VectorXd column = columns.col(static_cast<Eigen::Index>(j));
    const Eigen::Map<const Eigen::MatrixXd> by_channel(column.data(), c.channels, column.size() / c.channels);
    const double rms =
        std::sqrt(by_channel.rowwise().squaredNorm().maxCoeff() / static_cast<double>(by_channel.cols()));
    family.amplitudes[j].prior_sd = plausible_rad / std::max(rms, 1e-12);
  }
}

bool Has(const std::vector<std::string>& names, const std::string& name) {
  return std::ranges::find(names, name) != names.end();
}

/// With one or two heads and no interferometer, a ring that sits otherwise in another mounting looks the same.
bool IsDoubled(const Family& family, const SignalContext& c) {
  constexpr Eigen::Index kTelling = 3;
  return family.where == "table" && c.channels == 1 && SetUps(c).cols() < kTelling && family.effect != "slip";
}

}  // namespace

std::vector<Family> Families(const HobRun& hob, const std::vector<std::string>& struck) {
  const auto context = std::make_shared<const SignalContext>(hob.context);
  const Common common = CommonOf(context, LargestOrder(*context));
  std::vector<Family> families;
  AddRings(common, families);
  AddHobSignals(context, families);
  AddChain(common, families);
  AddTime(common, families);
  std::erase_if(families, [&](const Family& family) { return Has(struck, family.effect); });
  const double plausible_rad = std::max(kPlausible_rad, 3.0 * hob.run.sigma.minCoeff());
  for (Family& family : families) {
    SetPriors(*context, plausible_rad, family);
    if (IsDoubled(family, *context)) family.most_probable = kMostProbableDoubled;
  }
  std::ranges::move(UnknownFamilies(hob, common, plausible_rad), std::back_inserter(families));
  return families;
}

}  // namespace twinbench::diagnose::hob
