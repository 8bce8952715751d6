#pragma once

#include <string>
#include <vector>

#include "twin/benches/freeform_five_axis/estimators/pose_terms.h"

/// Errors of a machine from displacements at poses, as far as they are in them.
namespace twinbench::benches::freeform::estimators {

/// An error that is part of the fit.
struct FittedTerm {
  PoseTerm term;
  double value = 0.0, u = 0.0;  // in its unit
  /// Of `untold`: what moves the ball alike, so that the value is theirs as well.
  std::vector<std::size_t> looks_like{};
  bool hangs_on_chain = false;  // another chain that the readings allow finds another value, or none
};

/// One that moves the ball as others do, and is taken as none; or that moves nothing at these poses.
struct UntoldTerm {
  PoseTerm term;
  std::vector<std::size_t> looks_like{};  // of `fitted`; empty: it moves nothing
};

/// What the ball went along a machine axis between the first and the last reading, seen as the readings are.
struct Drift {
  std::string along;
  double over_run_um = 0.0, u_um = 0.0;
};

/// A reading of which a value lies far from the fit of all others.
struct FarShift {
  int reading = 0, component = 0;  // component: x, y, z
  Eigen::Vector3d turned_rad;      // A, B, C
  double off_um = 0.0, times = 0.0;  // times: the scatter of the others
};

struct DisplacementFit {
  MachineChain chain;
  bool on_workpiece = false;                // X, Y, Z are places of balls on it
  bool from_tool = true;                    // what is displaced is the workpiece, seen from the tool
  std::vector<std::string> other_chains{};  // that the poses and displacements allow as well
  std::size_t readings = 0, values = 0, balls = 0;
  int highest_order = 0;
  std::vector<FittedTerm> fitted{};
  std::vector<UntoldTerm> untold{};
  std::vector<Drift> drift{};  // none: the readings show none
  std::vector<FarShift> left_out{};
  std::vector<double> singular_values{};  // of all terms in unit columns, descending, the largest is 1
  Eigen::Index rank = 0, dof = 0;
  double residual_um = 0.0;   // rms per degree of freedom
  double displaced_um = 0.0;  // rms of the readings
  double repeat_um = 0.0;     // standard deviation of readings of one pose; NaN: too few
};

/// Weighted alike. A term is fitted if a fiftieth of what it does is done by none before it (pose_terms.h has the
/// order). All components, those too that the poses do not tell, are believed to be as large as the readings make
/// likely, those of an axis alike but for the order, or more at a single order that shows more: nothing, or their
/// part is in u. The highest orders are left out until the
/// unknowns are four for five values.
///
/// A reading of which a value lies far from the fit of all others is left out.
///
/// Uncertainty: what is left over, first order. Not included: errors that are no terms, or whose part is less than
/// chance; that rotary axes are where the commanded positions say.
/// @throws InputError if there are fewer than 12 values, or the commanded positions are those of no such machine.
DisplacementFit FitDisplacements(const DisplacementSettings& settings, const std::vector<Reading>& readings);

/// "A carries C, C against the right-hand rule".
std::string WordsOf(const MachineChain& chain);

}  // namespace twinbench::benches::freeform::estimators
