#include "twin/diagnose/rotary/family_parts.h"

#include <algorithm>
#include <cmath>

#include "twin/benches/rotary_4dof/format.h"
#include "twin/core/effect_catalogue.h"
#include "twin/core/errors.h"
#include "twin/core/units.h"
#include "twin/diagnose/engine/catalogue_parts.h"

namespace twinbench::diagnose::rotary {
namespace {

using units::arcsec;
using units::mrad;
using units::um;

/// What is plausible before checking (knowledge of such benches), and what is physically possible at all.
struct Plausible {
  double sd, lower, upper;
};
Plausible PlausibleOf(const std::string& effect, const std::string& parameter) {
  const auto both = [](double sd, double limit) { return Plausible{sd, -limit, limit}; };
  if (effect == "psd_gain") return both(0.005, 0.2);
  if (effect == "psd_roll") return both(6 * mrad, 150 * mrad);
  if (effect == "psd_nonlinearity") return both(2e5, 5e6);
  if (effect == "stray_light") return {0.006, 0.0, 0.3};
  if (effect == "psd_distance") return both(0.7e-3, 20e-3);
  if (effect == "wavelength_offset") return both(4e-9, 40e-9);
  if (effect == "grating_pitch") return both(1e-3, 0.06);
  if (effect == "mode_hop") return both(0.3e-9, 5e-9);
  if (effect == "wavelength_temperature") return both(0.05e-9, 1e-9);
  if (effect == "incidence_offset") return both(6 * mrad, 100 * mrad);
  if (effect == "laser_drift") return both(20e-6 / units::hour, 1e-3 / units::hour);
  if (effect == "mount_creep") return both(2 * arcsec, 200 * arcsec);
  if (effect == "thermal_tilt") return both(5 * arcsec, 200 * arcsec);
  if (effect == "backlash") return {1 * arcsec, 0.0, 300 * arcsec};
  if (effect == "settling") return both(5 * arcsec, 300 * arcsec);
  if (effect == "bearing_half_frequency") return both(1 * arcsec, 30 * arcsec);
  if (effect == "slip") return parameter == "shift" ? both(4 * um, 500 * um) : both(3 * arcsec, 500 * arcsec);
  if (effect == "adc_step") return both(4e-3, 0.3);
  if (effect == "crosstalk") return both(0.01, 0.3);
  if (effect == "tone") return both(0.5 * um, 100 * um);
  Require(false, "no plausible size is known for an effect");
  return {};
}

}  // namespace

Amplitude AmplitudeOf(const std::string& effect, const std::string& parameter) {
  const EffectParameter& p = CatalogueParameter(benches::rotary::Format().effects, effect, parameter);
  const Plausible plausible = PlausibleOf(effect, parameter);
  return {parameter, p.unit, p.to_SI, plausible.sd, plausible.lower, plausible.upper};
}

Shape ShapeOf(const std::string& effect, const std::string& parameter, std::vector<double> values) {
  const EffectParameter& p = CatalogueParameter(benches::rotary::Format().effects, effect, parameter);
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const double lower = *low, upper = *high;
  return {parameter, p.unit, p.to_SI, lower, upper, std::move(values)};
}

std::vector<double> Logarithmic(double lower, double upper, int count) {
  std::vector<double> values;
  for (int k = 0; k < count; ++k) values.push_back(lower * std::pow(upper / lower, k / (count - 1.0)));
  return values;
}

std::vector<double> Even(double lower, double upper, int count) {
  std::vector<double> values;
  for (int k = 0; k < count; ++k) values.push_back(lower + (upper - lower) * k / (count - 1.0));
  return values;
}

Family Named(const std::string& effect, const std::string& where, std::vector<Amplitude> amplitudes) {
  Family family;
  family.effect = family.group = effect;
  family.where = where;
  family.amplitudes = std::move(amplitudes);
  return family;
}

void SetSignal(Family& family, const std::function<Eigen::MatrixXd(const Eigen::VectorXd&)>& at) {
  std::vector<Eigen::VectorXd> grid;
  for (int g = 0; g < family.grid; ++g) grid.push_back(family.ShapeAt(g));
  family.columns = [at, grid](int g) { return at(grid[static_cast<std::size_t>(g)]); };
  family.at = at;
}

Family SignalFamily(const std::string& effect, const std::string& where, std::vector<Amplitude> amplitudes,
                    std::vector<Shape> shapes, const SignalContext& context) {
  Family family = Named(effect, where, std::move(amplitudes));
  family.shapes = std::move(shapes);
  family.grid = family.shapes.empty() ? 1 : static_cast<int>(std::ssize(family.shapes[0].value));
  std::vector<std::string> names;
  for (const Shape& s : family.shapes) names.push_back(s.name);
  SetSignal(family, [effect, where, names, &context](const Eigen::VectorXd& shape) {
    Parameters parameters;
    for (std::size_t k = 0; k < names.size(); ++k) parameters[names[k]] = shape[static_cast<Eigen::Index>(k)];
    return EffectSignal(effect, where, parameters, context);
  });
  return family;
}

ParameterEstimate LengthOf(const Amplitude& a, const Eigen::Vector2d& pair, const Eigen::MatrixXd& cov) {
  const double length = pair.norm();
  const Eigen::Vector2d along = length > 0.0 ? Eigen::Vector2d(pair / length) : Eigen::Vector2d(1.0, 0.0);
  return {a.name, a.unit, a.to_SI, length, std::sqrt(along.dot(cov.topLeftCorner<2, 2>() * along)), 0.0, a.upper};
}

ParameterEstimate Plain(const Shape& shape, double value, double u) {
  return {shape.name, shape.unit, shape.to_SI, value, u, shape.lower, shape.upper};
}

}  // namespace twinbench::diagnose::rotary
