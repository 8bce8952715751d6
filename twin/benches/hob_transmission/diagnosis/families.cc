#include "twin/benches/hob_transmission/diagnosis/families.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "twin/benches/hob_transmission/diagnosis/family_parts.h"
#include "twin/core/units.h"
#include "twin/diagnose/tuning.h"

namespace twinbench::diagnose::hob {
namespace {

constexpr double kPlausible_rad = 0.3 * units::arcsec;

bool Has(const std::vector<std::string>& names, const std::string& name) {
  return std::ranges::find(names, name) != names.end();
}

/// With one or two heads and no interferometer, a ring that sits otherwise in another mounting looks the same.
bool IsDoubled(const Family& family, const SignalContext& c) {
  constexpr Eigen::Index kTelling = 3;
  return family.where == "table" && c.channels == 1 && SetUps(c).cols() < kTelling && family.effect != "slip";
}

}  // namespace

std::vector<Family> Families(const HobRun& hob, const std::vector<std::string>& excluded) {
  const auto context = std::make_shared<const SignalContext>(hob.context);
  const Common common = CommonOf(context, LargestOrder(*context));
  const double plausible_rad = std::max(kPlausible_rad, 3.0 * hob.run.sigma.minCoeff());
  std::vector<Family> families = NamedFamilies(common, plausible_rad);
  std::erase_if(families, [&](const Family& family) { return Has(excluded, family.effect); });
  for (Family& family : families) {
    if (IsDoubled(family, *context)) family.listed = tuning::kListedDoubled;
  }
  std::ranges::move(UnknownFamilies(hob, common, plausible_rad), std::back_inserter(families));
  return families;
}

}  // namespace twinbench::diagnose::hob
