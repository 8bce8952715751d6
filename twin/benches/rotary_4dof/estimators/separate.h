#pragma once

#include <Eigen/Core>
#include <array>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "twin/benches/rotary_4dof/estimators/design.h"
#include "twin/benches/rotary_4dof/estimators/measure.h"
#include "twin/benches/rotary_4dof/estimators/separability.h"
#include "twin/core/scenario.h"
#include "twin/core/table_errors.h"
#include "twin/separate/curve_covariance.h"

/// Front door of the room: from motions of the grating to the errors of both tables.
namespace twinbench::separate {

/// The error motion that each of the four measured motions is, in the order of measure::Dof.
inline constexpr std::array<Component, measure::kDofs> kComponentOf = {Component::kEz, Component::kEx,
                                                                       Component::kEy, Component::kDy};

using measure::Matrix6;

struct SeparateOptions {
  Estimator estimator = Estimator::kRigorous;
  LayoutOptions layout;
  Matrix6 cov_calibration = Matrix6::Zero();  // of gains and rolls, for the systematic part (Calibration::cov)
  /// What the bearings of target and reference do not repeat, root mean square by component. All passes of a run go
  /// over the same turn, so none of them shows it.
  std::array<std::array<double, kComponents>, 2> asynchronous = {};
};

/// Positions and clamping of a scenario's procedure.
/// @throws InputError if clamping is neither "reclamp" nor "reseat".
SeparateOptions OptionsFrom(const Scenario& scenario);

/// Errors of one table at its n positions, ascending own angle in [0, 2 pi). Values have zero mean; what cannot be
/// separated is taken out. A position that the readings do not determine is NaN.
struct TableEstimate {
  TableErrors value;                  // dx, dy, dz that are not determined: NaN
  TableErrors u;                      // standard uncertainty: random and systematic together
  std::vector<Component> components;  // determined ones, in the order of the blocks of both matrices
  CurveCovariance cov;             // random part; row s * n + i is components[s] at position i [rad^2, rad m, m^2]
  CurveCovariance cov_systematic;  // of the calibration, of the model's second order, and of published equations
  double second_order = 0.0;       // variance of the model's second order, as a part of the random one
  std::array<double, kComponents> asynchronous = {};  // root mean squares, as a part of cov_systematic
};

/// Mean motion of a set-up over its positions minus that of the first: zero if nothing was re-mounted differently
/// and all is scalar (eq. 19 of the paper); in `reclamp` it holds (e^{j Delta} - 1) W_0 as well.
struct Closure {
  int setup = 0;
  Vector4 difference = Vector4::Constant(kNaN);  // [ez, ex, ey, dy]
};

struct Separation {
  Estimator estimator = Estimator::kRigorous;
  TableEstimate target;     // in L
  TableEstimate reference;  // in its rotor frame
  std::vector<NotSeparable> not_separable;

  // By motion [ez, ex, ey, dy]:
  Vector4 residual_rms = Vector4::Constant(kNaN);
  Vector4 chi2 = Vector4::Constant(kNaN);          // against the stated covariances
  Vector4 dof_of = Vector4::Constant(kNaN);        // degrees of freedom of each; they sum up to dof
  Vector4 chi2_of_stops = Vector4::Constant(kNaN), dof_of_stops = Vector4::Constant(kNaN);  // of the passes' means
  Vector4 scale = Vector4::Ones();                 // applied to the readings' standard uncertainties
  Vector4 second_order = Vector4::Constant(kNaN);  // what the model may miss of a motion (UnreadSecondOrder)
  int dof = 0;                                     // readings - rank
  int readings = 0;                                // used
  std::vector<Vector4> residuals;                  // one a motion handed in; NaN if not used
  std::vector<Closure> closure;
  std::vector<Vector4> mount;  // constants of each set-up; defined up to what cannot be separated
  std::vector<std::string> notes;
};

/// Separates full-circle motions into the errors of target and reference.
///
/// kRigorous: weighted least squares over all set-ups, passes and four motions at once, with second-order terms by
/// iteration on the exact chain; any shift set, missing readings allowed. kPublished: see published.h.
///
/// @param motions  From measure::Measure(); only full-circle motions with status ok are used. Weights are the mean
///                 covariance of each pass of a set-up. If covariances are not known, equal noise on the PSD axes
///                 is assumed and scaled, motion by motion, to the residual scatter (but see AssumedNoiseScale). If
///                 the residuals of a motion exceed its stated covariance (p < 0.001), its uncertainty is scaled up
///                 (Birge) and a note says so.
/// @throws InputError if the angles do not lie on a grid or contradict each other (FindLayout).
///
/// Uncertainty: first-order propagation of readings and calibration, and a floor for products of errors with what
/// the bench does not read (UnreadSecondOrder, about 1 milliarcsec): far below real noise, all there is without
/// noise. Not included: drift, effects that are not of the form target + reference; they show in chi2 when there
/// are more than two set-ups. Reference: docs/theory.md 2-4, 11.5.
Separation Separate(const std::vector<Motion>& motions, const BenchGeometry& geometry,
                    const SeparateOptions& options);

/// `separation.json` of formats.md, with estimator and notes besides. Components that are not determined are left
/// out and listed; a single position that is lost is null.
nlohmann::json ToJson(const Separation& separation);

}  // namespace twinbench::separate
