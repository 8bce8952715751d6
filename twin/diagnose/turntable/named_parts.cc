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

std::vector<double> ToneFrequencies_Hz(const Schedule& s) {
  constexpr int kMost = 1200;
  std::vector<double> steps_s;
  for (Eigen::Index i = 1; i < s.time_s.size(); ++i) steps_s.push_back(s.time_s[i] - s.time_s[i - 1]);
  std::nth_element(steps_s.begin(), steps_s.begin() + std::ssize(steps_s) / 2, steps_s.end());
  const double usual_s = std::max(steps_s[steps_s.size() / 2], 1e-3);
  const double duration_s = std::max(s.time_s.maxCoeff() - s.time_s.minCoeff(), usual_s);
  const double width_Hz = 0.6 / duration_s, first_Hz = 3.0 * width_Hz;  // slower ones are a wander
  const double last_Hz = std::max(0.5 / usual_s, 2.0 * first_Hz);
  const int count = std::clamp(static_cast<int>((last_Hz - first_Hz) / width_Hz), 2, kMost);
  std::vector<double> frequencies_Hz;
  for (int k = 0; k < count; ++k) frequencies_Hz.push_back(first_Hz + k * (last_Hz - first_Hz) / (count - 1));
  return frequencies_Hz;
}

}  // namespace twinbench::diagnose::turntable
