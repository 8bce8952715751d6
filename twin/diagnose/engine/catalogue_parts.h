#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "twin/core/effect_catalogue.h"
#include "twin/diagnose/engine/family.h"

/// Parts of families that are named after an effect of a bench's catalogue.
namespace twinbench::diagnose {

/// @param catalogue  Outlives what is returned.
/// @throws std::logic_error if the catalogue has no such effect or parameter.
const EffectParameter& CatalogueParameter(const std::vector<EffectEntry>& catalogue, const std::string& effect,
                                          const std::string& parameter);

/// The parameter as fitted [SI].
ParameterEstimate EstimateOf(const EffectParameter& parameter, double value, double u);

/// Without amplitudes and columns.
Family NamedFamily(const std::string& effect, const std::string& where = "");

/// `count` values from `first` to `last` in equal ratios.
std::vector<double> Ratios(double first, double last, int count);

/// Of a cos + b sin = size cos(angle + phase): size, phase and their standard uncertainties. The same wave has many
/// sizes and phases; this is the one with size >= 0 and 0 <= phase <= 2 pi.
struct Polar {
  double size, phase_rad, u_size, u_phase_rad;
};
Polar PolarOf(const Eigen::VectorXd& x, const Eigen::MatrixXd& cov);

/// Of a parameter whose place in `cov` (amplitudes, then shapes) is `at`; NaN if it has none there.
double DeviationAt(const Eigen::MatrixXd& cov, Eigen::Index at);

}  // namespace twinbench::diagnose
