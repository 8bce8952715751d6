#pragma once

#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace twinbench::uncertainty {

/// A number of results.json that has its standard uncertainty beside it.
struct Quantity {
  std::string name;  // its place: "separation.target.ez_arcsec[3]"
  double value = 0.0;
  double u = 0.0;                                        // as the estimator states it, in the same unit
  double dof = std::numeric_limits<double>::infinity();  // of u: "dof" nearest above it
};

/// All that the document states, in its order: `x` beside `u_x` (numbers, lists of numbers or objects of either),
/// `value` beside `u`, `value_um` beside `u_um`. Its name is its path, without `value`: "setups[0].offset_x_um".
/// What is null was not determined and is NaN. What a diagnosis adds is no result of the measurement and is left
/// out.
std::vector<Quantity> StatedQuantities(const nlohmann::json& results);

/// Those of them that are numbers with an uncertainty.
std::vector<Quantity> QuantitiesOf(const nlohmann::json& results);

/// "separation.target.ez_arcsec": the name without the place in a list.
std::string ListOf(const std::string& name);

/// "iso230_2[].targets[].mean_arcsec": likewise, and without the place in any list on the way to it.
std::string KindOf(const std::string& name);

}  // namespace twinbench::uncertainty
