#pragma once

#include <functional>
#include <string>
#include <vector>

#include "twin/core/scenario.h"
#include "twin/uncertainty/quantities.h"

namespace twinbench::uncertainty {

/// The readings of one run, evaluated with what a scenario says of the bench.
using Evaluate = std::function<std::vector<Quantity>(const Scenario&)>;

/// One source of uncertainty of one quantity.
struct Source {
  std::string name;  // "noise", "psd_a.distance_mm", "grating.point_mm[2]", "second order"
  char type = 'B';   // GUM: A by statistics, B by other means
  double u = 0.0;    // what it adds, |c_i| u(x_i) with the sign of c_i, in the quantity's unit
  double dof = std::numeric_limits<double>::infinity();
  // Of a constant of the scenario (GUM 5.1.3); NaN and empty of what the readings themselves leave:
  double u_input = std::numeric_limits<double>::quiet_NaN();      // u(x_i), in `input_unit`
  double sensitivity = std::numeric_limits<double>::quiet_NaN();  // c_i, quantity's unit per `input_unit`
  std::string input_unit = {};
};

struct Budget {
  Quantity quantity;  // with the u that the estimator states
  std::vector<Source> sources;
  double u = 0.0;                                        // combined standard uncertainty
  double dof = std::numeric_limits<double>::infinity();  // effective, by Welch and Satterthwaite
  double k = 2.0;                                        // coverage factor for 95 %
  double Expanded() const { return k * u; }
};

/// GUM propagation (JCGM 100, 5.1 and G.4) of every u_<key> of the scenario through the whole evaluation: the same
/// readings evaluated with the key one standard uncertainty up and down. A source acts on all readings at once, so
/// what it does to each quantity keeps its sign. Half the sum of both changes is what propagation to first order
/// leaves out; it is a line of its own (its standard deviation for a normal input).
///
/// What the readings themselves leave is taken from the estimator, part by part where it tells them apart
/// (Quantity::parts): what is seen to scatter is of type A, what is known of an instrument or a model of type B. All
/// have the degrees of freedom of the estimate that they come from, and count there as one.
///
/// Order: quantities as `evaluate` gives them.
std::vector<Budget> Budgets(const Scenario& scenario, const Evaluate& evaluate);

/// Sources that change none of the quantities, by name: the evaluation makes no use of that number of the scenario,
/// so that what an error of it does to the readings is in no budget.
std::vector<std::string> SourcesOfNothing(const std::vector<Budget>& budgets);

/// Whether a name is that of a part of what the readings leave, not of a constant of the scenario.
bool IsOfReadings(const Source& source);

/// Factor of a two-sided 95 % interval of Student's t.
double CoverageFactor(double dof);

}  // namespace twinbench::uncertainty
