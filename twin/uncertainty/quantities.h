#pragma once

#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace twinbench::uncertainty {

/// What one source has of u^2 of a result, as its estimator knows it.
struct Part {
  std::string name;  // "noise", "quantisation", "repeatability", ...
  double share = 0.0;
};

/// A number of results.json that has its standard uncertainty beside it.
struct Quantity {
  std::string name;  // its place: "separation.target.ez_arcsec[3]"
  double value = 0.0;
  double u = 0.0;                                        // as the estimator states it, in the same unit
  double dof = std::numeric_limits<double>::infinity();  // of u: "dof" nearest above it
  std::vector<Part> parts = {};                          // of u: "u_parts" nearest above it; empty: not told apart
};

/// All that the document states, in its order: `x` beside `u_x` (numbers, lists of numbers or objects of either),
/// `value` beside `u`, `value_um` beside `u_um`. Its name is its path, without `value`: "setups[0].offset_x_um".
/// What is null was not determined and is NaN. What a diagnosis adds is no result of the measurement, and a list in order of size
/// (`ranked`) says once more what stands elsewhere, in several units: both are left out.
///
/// `u_parts` holds for all below it until another comes: {"noise": 0.7, "quantisation": 0.3}, a share of u^2 or a
/// list of them by the place in the innermost list; or the same for single keys, {"ez_arcsec": {"noise": ...}}.
std::vector<Quantity> StatedQuantities(const nlohmann::json& results);

/// Those of them that are numbers with an uncertainty.
std::vector<Quantity> QuantitiesOf(const nlohmann::json& results);

/// "arcsec" of "separation.target.ez_arcsec[3]"; empty if the name ends in no unit.
std::string UnitOf(const std::string& name);

/// "separation.target.ez_arcsec": the name without the place in a list.
std::string ListOf(const std::string& name);

/// "iso230_2[].targets[].mean_arcsec": likewise, and without the place in any list on the way to it.
std::string KindOf(const std::string& name);

}  // namespace twinbench::uncertainty
