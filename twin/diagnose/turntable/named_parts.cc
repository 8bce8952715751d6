#include "twin/diagnose/turntable/named_parts.h"

#include <algorithm>
#include <cmath>

#include "twin/benches/turntable_autocollimator/format.h"
#include "twin/core/units.h"

namespace twinbench::diagnose::turntable {
namespace {

const EffectParameter& Entry(const std::string& effect, const std::string& parameter) {
  return CatalogueParameter(benches::turntable::Format().effects, effect, parameter);
}

}  // namespace

Amplitude AmplitudeOf(const std::string& effect, const std::string& parameter) {
  const EffectParameter& p = Entry(effect, parameter);
  return {parameter, p.unit, p.to_SI, std::abs(p.default_SI), p.lower_SI, p.upper_SI};
}

Shape ShapeOf(const std::string& effect, const std::string& parameter, std::vector<double> values_SI) {
  const EffectParameter& p = Entry(effect, parameter);
  const auto [least, most] = std::ranges::minmax(values_SI);
  return {parameter,           p.unit, p.to_SI, std::max(p.lower_SI, least), std::min(p.upper_SI, most),
          std::move(values_SI)};
}

ParameterEstimate Estimate(const std::string& effect, const std::string& parameter, double value, double u) {
  return EstimateOf(Entry(effect, parameter), value, u);
}

Family Linear(const std::string& effect, const std::string& where, const std::string& parameter,
              const Eigen::MatrixXd& rows) {
  Family family = NamedFamily(effect, where);
  family.amplitudes = {AmplitudeOf(effect, parameter)};
  family.columns = [rows](int) { return rows; };
  return family;
}

Family Shaped(const std::string& effect, int axis, std::vector<Amplitude> amplitudes, const Shape& shape,
              const Signal& signal) {
  Family family = NamedFamily(effect, kAxisNames[static_cast<std::size_t>(axis)]);
  family.amplitudes = std::move(amplitudes);
  family.shapes = {shape};
  family.grid = static_cast<int>(std::ssize(shape.value));
  family.at = [axis, signal](const Eigen::VectorXd& at) { return OnAxis(signal(at), axis); };
  family.columns = [at = family.at, values = shape.value](int g) {
    return at(Eigen::VectorXd::Constant(1, values[static_cast<std::size_t>(g)]));
  };
  return family;
}

std::vector<Amplitude> WaveAmplitudes(const std::string& effect) {
  std::vector<Amplitude> waves(2, AmplitudeOf(effect, "amplitude"));
  waves[1].name = "quadrature";
  return waves;
}

void ReportWave(const std::string& effect, const std::string& shape_name, Family& family) {
  family.parameters = [effect, shape_name](const Eigen::VectorXd& shape, const Eigen::VectorXd& x,
                                           const Eigen::MatrixXd& cov) {
    const Polar polar = PolarOf(x, cov);
    return std::vector{Estimate(effect, "amplitude", polar.size, polar.u_size),
                       Estimate(effect, shape_name, shape[0], DeviationAt(cov, x.size())),
                       Estimate(effect, "phase", polar.phase_rad, polar.u_phase_rad)};
  };
}

Eigen::MatrixXd MapOfAxis(int axis, int signals) {
  Eigen::MatrixXd map = Eigen::MatrixXd::Zero(kAxes * signals, signals);
  map.middleRows(axis * signals, signals).setIdentity();
  return map;
}

}  // namespace twinbench::diagnose::turntable
