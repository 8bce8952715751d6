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

/// All of them, in the order of the document: `x` beside `u_x` (numbers, lists of numbers or objects of either) and
/// objects of `value` and `u`. What a diagnosis adds is no result of the measurement and is left out.
std::vector<Quantity> QuantitiesOf(const nlohmann::json& results);

/// "separation.target.ez_arcsec": the name without the place in a list.
std::string ListOf(const std::string& name);

}  // namespace twinbench::uncertainty
