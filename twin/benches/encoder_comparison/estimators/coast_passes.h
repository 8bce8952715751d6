#pragma once

#include <Eigen/Core>
#include <vector>

#include "twin/core/reading.h"

/// Times at which the lines of a ring pass its head while the spindle runs down.
///
/// In a pass of the direction s the scale shows a line's angle L when the shaft has come to phi(t):
///
///   L = phi(t) + e(L) + constant
///
/// e: the ring's error; phi: smooth where nothing acts on the spindle that repeats with its angle.
namespace twinbench::separate::encoder {

/// One pass; one entry a line, in the order in which they passed.
struct CoastPass {
  int pass = 0, direction = 1;
  std::vector<long> line;    // its number, unwrapped; line modulo lines of a turn is its place on the ring
  std::vector<double> time_s;
};

struct CoastPasses {
  int lines = 0;       // of a turn, whose times are taken; 0: not told by the readings
  double zero_rad = 0.0;  // angle of line 0
  std::vector<CoastPass> passes;
  int left_out = 0;  // readings without a time

  double Step_rad() const;
};

/// Readings of kind coast: a finite stamp_s.
CoastPasses SortCoast(const std::vector<Reading>& readings);

bool HaveStamps(const std::vector<Reading>& readings);

/// What a whole turn of a pass shows, as Fourier coefficients of the lines' angles less a course of the shaft.
struct CoastTurn {
  int pass = 0, direction = 1;
  double speed_rad_s = kNaN;  // mean, without its sign
  Eigen::VectorXcd order;     // [k - 1]
};

/// Orders 1 to `highest` of every turn of a pass whose lines are all there.
/// @param off_rad  Angle of each line of the pass less the shaft's course.
std::vector<CoastTurn> TurnsOf(const CoastPasses& coast, const CoastPass& pass, const Eigen::VectorXd& off_rad,
                               int highest);

/// The lines' angles less a polynomial of the time, fitted together with what repeats every turn.
Eigen::VectorXd OffSmoothCourse(const CoastPasses& coast, const CoastPass& pass, int degree);

/// The lines' angles less the parabola, turn by turn, that passes through its first line where that passes again and
/// a third time (circular closure): whatever the ring errs, these are whole turns. NaN in the last turn.
Eigen::VectorXd OffClosedTurns(const CoastPasses& coast, const CoastPass& pass);

/// The same as a comparison of angles, for whoever does not know of times: the mean of the turns of each pass at
/// `places` lines of the turn, every pass a set-up, the reference being the smooth course. What acts on the spindle by
/// its angle counts as the device's.
std::vector<Reading> AsComparison(const std::vector<Reading>& readings, int places = 128);

}  // namespace twinbench::separate::encoder
