#include "twin/diagnose/engine/catalogue_parts.h"

#include <algorithm>
#include <cmath>

#include "twin/core/errors.h"
#include "twin/core/units.h"

namespace twinbench::diagnose {

const EffectParameter& CatalogueParameter(const std::vector<EffectEntry>& catalogue, const std::string& effect,
                                          const std::string& parameter) {
  const auto entry = std::ranges::find(catalogue, effect, &EffectEntry::name);
  Require(entry != catalogue.end(), "a family names an effect that the catalogue has not");
  const auto found = std::ranges::find(entry->parameters, parameter, &EffectParameter::name);
  Require(found != entry->parameters.end(), "a family names a parameter that the catalogue has not");
  return *found;
}

ParameterEstimate EstimateOf(const EffectParameter& p, double value, double u) {
  return {p.name, p.unit, p.to_SI, value, u, p.lower_SI, p.upper_SI};
}

Family NamedFamily(const std::string& effect, const std::string& where) {
  Family family;
  family.kind = Kind::kNamed;
  family.effect = family.group = effect;
  family.where = where;
  return family;
}

std::vector<double> Ratios(double first, double last, int count) {
  std::vector<double> values;
  for (int k = 0; k < count; ++k) values.push_back(first * std::pow(last / first, k / std::max(1.0, count - 1.0)));
  return values;
}

Polar PolarOf(const Eigen::VectorXd& x, const Eigen::MatrixXd& cov) {
  const double size = x.head<2>().norm(), safe = std::max(size, 1e-300);
  const Eigen::Vector2d along = x.head<2>() / safe, across(-along[1], along[0]);
  const Eigen::Matrix2d c = cov.topLeftCorner<2, 2>();
  const double phase_rad = -std::atan2(x[1], x[0]);
  return {size, phase_rad < 0.0 ? phase_rad + 2.0 * units::kPi : phase_rad, std::sqrt(along.dot(c * along)),
          std::sqrt(across.dot(c * across)) / safe};
}

double DeviationAt(const Eigen::MatrixXd& cov, Eigen::Index at) {
  return at < cov.cols() ? std::sqrt(cov(at, at)) : kNaN;
}

}  // namespace twinbench::diagnose
