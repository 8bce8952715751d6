#include "twin/diagnose/encoder/named_parts.h"

#include <algorithm>
#include <cmath>

#include "twin/benches/encoder_comparison/format.h"
#include "twin/core/units.h"

namespace twinbench::diagnose::encoder {
namespace {

const EffectParameter& Entry(const std::string& effect, const std::string& parameter) {
  return CatalogueParameter(benches::encoder::Format().effects, effect, parameter);
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
  return EstimateOf(Entry(effect, parameter), value, u);
}

Family Named(const std::string& effect) {
  return NamedFamily(effect);
}

Family Linear(const std::string& effect, const std::vector<std::string>& parameters,
              const Eigen::MatrixXd& columns) {
  Family family = Named(effect);
  for (const std::string& parameter : parameters) family.amplitudes.push_back(AmplitudeOf(effect, parameter));
  family.columns = [columns](int) { return columns; };
  return family;
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
