#include "twin/diagnose/encoder/named_parts.h"

#include <algorithm>
#include <cmath>

#include "twin/core/errors.h"
#include "twin/core/units.h"

namespace twinbench::diagnose::encoder {
namespace {

const EffectParameter& Entry(const std::string& effect, const std::string& parameter) {
  const EffectEntry* entry = FindEffect(effect, kEncoderBench);
  Require(entry != nullptr, "a family names an effect that the catalogue has not");
  for (const EffectParameter& p : entry->parameters) {
    if (p.name == parameter) return p;
  }
  Require(false, "a family names a parameter that the catalogue has not");
  return entry->parameters.front();
}

}  // namespace

Amplitude AmplitudeOf(const std::string& effect, const std::string& parameter) {
  const EffectParameter& p = Entry(effect, parameter);
  return {parameter, p.unit, p.to_SI, kPriorToBeSet, p.lower_SI, p.upper_SI};
}

Shape ShapeOf(const std::string& effect, const std::string& parameter, std::vector<double> values_SI) {
  const EffectParameter& p = Entry(effect, parameter);
  return {parameter, p.unit, p.to_SI, p.lower_SI, p.upper_SI, std::move(values_SI)};
}

ParameterEstimate Estimate(const std::string& effect, const std::string& parameter, double value, double u) {
  const EffectParameter& p = Entry(effect, parameter);
  ParameterEstimate estimate;
  estimate.name = p.name;
  estimate.unit = p.unit;
  estimate.to_SI = p.to_SI;
  estimate.value = value;
  estimate.u = u;
  estimate.lower = p.lower_SI;
  estimate.upper = p.upper_SI;
  return estimate;
}

Family Named(const std::string& effect) {
  Family family;
  family.kind = Kind::kNamed;
  family.effect = family.group = effect;
  return family;
}

Family Linear(const std::string& effect, const std::vector<std::string>& parameters,
              const Eigen::MatrixXd& columns) {
  Family family = Named(effect);
  for (const std::string& parameter : parameters) family.amplitudes.push_back(AmplitudeOf(effect, parameter));
  family.columns = [columns](int) { return columns; };
  return family;
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

Parameters ReportOnly(const std::string& effect, const std::string& amplitude, const std::string& shape_name) {
  return [=](const Eigen::VectorXd& shape, const Eigen::VectorXd& x, const Eigen::MatrixXd& cov) {
    std::vector<ParameterEstimate> estimates = {Estimate(effect, amplitude, x[0], std::sqrt(cov(0, 0)))};
    if (!shape_name.empty())
      estimates.push_back(Estimate(effect, shape_name, shape[0], DeviationAt(cov, x.size())));
    return estimates;
  };
}

}  // namespace twinbench::diagnose::encoder
