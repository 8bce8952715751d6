#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "twin/investigate/means.h"
#include "twin/uncertainty/budget.h"

namespace twinbench::investigate {

/// How certain a result shall be: "target.ez 0.1arcsec".
struct Goal {
  std::string quantity;  // "target.ez", as results.json has it, or the end of its name
  std::string unit;      // "arcsec"; empty: of a pure number
  double u = 0.0;        // standard uncertainty, root mean square over its values

  std::string Text() const;
};

/// @throws InputError if it cannot be read.
Goal ParseGoal(const std::string& text);

/// What the runs so far say of the goal's quantity: at each of its places the inverse variances of runs add up, and
/// what all runs share - errors of the standards, of type B - is added to it and never grows less.
class Certainty {
 public:
  explicit Certainty(Goal goal) : goal_(std::move(goal)) {}

  /// @return false if the results have no such quantity.
  bool Add(const nlohmann::json& results);

  /// What all runs share, from the budgets of one of them: every source of type B but the rounding of readings.
  void Share(const std::vector<uncertainty::Budget>& budgets);
  /// Root mean square over the places of what they share: no number of runs is more certain.
  double SharedU() const;
  /// The source that has most of it: "laser.wavelength_nm"; empty if they share nothing.
  std::string LargestShared() const;

  /// Root mean square over the places; infinite as long as nothing was added.
  double u() const;
  /// With those results as well.
  double With(const nlohmann::json& results) const;
  bool IsMet() const { return u() <= goal_.u; }
  const Goal& goal() const { return goal_; }

 private:
  using Precision = std::map<std::string, double>;
  Precision Of(const nlohmann::json& results) const;
  double RootMeanSquare(const Precision& precision) const;
  bool IsOfGoal(const std::string& quantity) const;

  Goal goal_;
  Precision precision_;                             // by place
  std::map<std::string, double> shared_;            // variance by place
  std::map<std::string, double> shared_by_source_;  // variance, all places together
};

/// Of the results of these readings.
std::vector<uncertainty::Budget> BudgetsOf(const std::vector<Reading>& readings, const Scenario& scenario, const Means& means);

/// The lists of numbers in results that a goal can be about: "target.ez_arcsec".
std::vector<std::string> GoalNames(const nlohmann::json& results);

}  // namespace twinbench::investigate
