#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "twin/benches/rotary_4dof/estimators/probe_turns.h"
#include "twin/separate/error_motion.h"

/// Radial error motion of an axis and roundness of the artefact that the probes look at.
namespace twinbench::separate::rotary {

/// What the radial probes of a run come to.
struct RadialMotion {
  std::optional<ErrorMotion> along;     // one probe: in its direction
  std::optional<ErrorMotion> x, y;      // two probes and more; an artefact that was not separated is in them
  std::optional<ErrorMotion> rotating;  // cos(angle) x + sin(angle) y
  std::optional<ErrorMotion> artefact;  // deviation of its radius by its own angle, where it was separated
  std::string separated_by;             // "reversal", "probes"; empty: it was not
  std::vector<int> lost_orders;         // of a separation, from 2 on
};

/// Donaldson's reversal where one mounting is the reversal of another: the probe's readings are r + s and r - s, r
/// the artefact, s the axis. Else, of three probes and more, harmonic by harmonic by least squares: m_i(a) = r(a -
/// f_i) + x(a) cos f_i + y(a) sin f_i, f_i where probe i stands; orders of which the probes' angles tell nothing
/// (lost_orders) are counted as the axis'. Else two probes give x and y as they are.
///
/// Order 1 is where the artefact stands and never told.
/// @param radial   Columns of `turns` that are radial probes, in the order of `at_rad`.
/// @param at_rad   Where they stand, counter-clockwise.
/// @param reversed The mounting that is a reversal of the first other one; -1: none.
/// Uncertainty: scatter of the turns, pooled over the angles, propagated. Not included: scales and places of the
/// probes, an artefact that was not reversed by half a turn. Reference: Donaldson, Ann. CIRP 21 (1972) 125;
/// Whitehouse, J. Phys. E 9 (1976) 531 (multiprobe).
RadialMotion SeparateRadial(const std::vector<ProbeTurns>& mountings, const std::vector<std::size_t>& radial,
                            const std::vector<double>& at_rad, int reversed);

}  // namespace twinbench::separate::rotary
