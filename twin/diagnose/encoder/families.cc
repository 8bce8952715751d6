#include "twin/diagnose/encoder/families.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "twin/core/units.h"
#include "twin/diagnose/encoder/family_parts.h"

namespace twinbench::diagnose::encoder {
namespace {

constexpr double kPlausible_rad = 0.01 * units::deg;
constexpr int kMostOrders = 120;

double Rms(const Eigen::MatrixXd& columns, Eigen::Index j) {
  return std::sqrt(columns.col(j).squaredNorm() / static_cast<double>(columns.rows()));
}

/// Prior sizes, where they are not set, such that each amplitude leaves a trace of `plausible_rad` rms in the
/// middle of the grid.
void SetPriors(Family& family, double plausible_rad) {
  const Eigen::MatrixXd columns = family.columns(family.grid / 2);
  for (std::size_t j = 0; j < family.amplitudes.size(); ++j) {
    if (family.amplitudes[j].prior_sd != kPriorToBeSet) continue;
    const double rms = Rms(columns, static_cast<Eigen::Index>(j));
    family.amplitudes[j].prior_sd = plausible_rad / std::max(rms, 1e-12);
  }
}

bool Has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Typical distance of neighbouring readings in each pass; passes at rest are left out.
std::vector<double> Spacings_rad(const SignalContext& c) {
  std::map<int, std::vector<double>> steps;
  for (Eigen::Index i = 1; i < c.Readings(); ++i) {
    const double step_rad = std::abs(c.reference_rad[i] - c.reference_rad[i - 1]);
    if (c.pass[i] == c.pass[i - 1] && step_rad > units::urad) steps[c.pass[i]].push_back(step_rad);
  }
  std::vector<double> spacings;
  for (auto& [pass, step_rad] : steps) {
    std::nth_element(step_rad.begin(), step_rad.begin() + std::ssize(step_rad) / 2, step_rad.end());
    spacings.push_back(step_rad[step_rad.size() / 2]);
  }
  return spacings;
}

}  // namespace

int LargestOrder(const SignalContext& context) {
  const std::vector<double> spacings_rad = Spacings_rad(context);
  if (spacings_rad.empty()) return 0;
  const double finest_rad = *std::min_element(spacings_rad.begin(), spacings_rad.end());
  // Two readings a period, and a little more: at exactly two the sine may vanish at every stop.
  return std::min(kMostOrders, static_cast<int>(std::ceil(units::kPi / finest_rad - 1e-6)) - 1);
}

std::vector<double> WholeOrders(int first, int last) {
  std::vector<double> orders;
  for (int k = first; k <= last; ++k) orders.push_back(k);
  return orders;
}

double Turns(const SignalContext& c) {
  const double range_rad = c.reference_rad.maxCoeff() - c.reference_rad.minCoeff();
  return std::max(range_rad / (2.0 * units::kPi), 1e-3);
}

double Duration_s(const SignalContext& c) {
  return std::max(c.time_s.maxCoeff(), 1e-6);
}

bool TimeFollowsAngle(const SignalContext& c) {
  const Eigen::VectorXd t = c.time_s.array() - c.time_s.mean(),
                        a = c.reference_rad.array() - c.reference_rad.mean();
  return std::abs(t.dot(a)) > 0.999 * t.norm() * a.norm();
}

Eigen::MatrixXd Times(const Eigen::MatrixXd& columns, const Eigen::VectorXd& factor) {
  return columns.array().colwise() * factor.array();
}

namespace {

/// Generic shapes. One that a named cause has exactly is less likely to be something else: it counts less.
std::vector<Family> WeighedUnknown(const std::shared_ptr<const SignalContext>& context,
                                   const std::vector<Family>& named) {
  constexpr double kSameShape = 0.2;
  std::set<std::string> names, of_their_own;
  for (const Family& family : named) names.insert(family.effect);
  for (const Family& family : UnknownFamilies(context, {names.begin(), names.end()}))
    of_their_own.insert(family.effect);
  std::vector<Family> families = UnknownFamilies(context, {});
  for (Family& family : families) {
    if (!of_their_own.contains(family.effect)) family.prior_weight = kSameShape;
  }
  return families;
}

}  // namespace

std::vector<Family> Families(const EncoderRun& encoder, const std::vector<std::string>& struck) {
  const auto context = std::make_shared<const SignalContext>(encoder.context);
  const double plausible_rad = std::max(kPlausible_rad, 3.0 * encoder.run.sigma.mean());
  std::vector<Family> families = NamedFamilies(context, plausible_rad);
  std::vector<Family> unknown = WeighedUnknown(context, families);
  std::erase_if(families, [&](const Family& family) { return Has(struck, family.effect); });
  std::ranges::move(unknown, std::back_inserter(families));
  // One mounting cannot tell a fault of the device from the same order of the reference.
  const std::vector<std::string> doubled = {"eccentricity",       "signal_offset",    "ellipticity",
                                            "amplitude_mismatch", "quadrature_error", "periodic"};
  for (Family& family : families) {
    SetPriors(family, plausible_rad);
    if (Has(doubled, family.effect)) family.most_probable = kMostProbableDoubled;
  }
  return families;
}

}  // namespace twinbench::diagnose::encoder
