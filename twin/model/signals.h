#pragma once

#include <Eigen/Core>
#include <vector>

#include "twin/model/course.h"

/// Time courses that causes follow, written once for all benches: one row a reading of a course, dimensionless or
/// in SI, before any size.
namespace twinbench::model {

// --- putting together ---

/// Each row of `columns` times the entry of `factor`.
Eigen::MatrixXd Times(const Eigen::MatrixXd& columns, const Eigen::VectorXd& factor);

/// Root of the mean square.
double Rms(const Eigen::VectorXd& signal);

/// Divided by its rms.
Eigen::VectorXd Unit(const Eigen::VectorXd& signal);

/// 1 where a label has a value: readings x values, ascending.
Eigen::MatrixXd Indicators(const std::vector<int>& label);

/// The columns with a size of their own for each indicator: readings x (columns x indicators).
Eigen::MatrixXd InEach(const Eigen::MatrixXd& columns, const Eigen::MatrixXd& indicators);

/// A label of its own for every pass of every set-up.
std::vector<int> Visits(const Course& course);

// --- angle ---

/// [cos phase, sin phase]: readings x 2.
Eigen::MatrixXd Wave(const Eigen::VectorXd& phase_rad);

// --- time ---

/// From 0 to 1 over the whole course.
Eigen::VectorXd ElapsedShare(const Course& course);

/// t, and t (1 - t / 1 h): a drift and a quadratic part of it that is zero at 0 and 1 h: readings x 2 [s].
Eigen::MatrixXd Drift_s(const Eigen::VectorXd& time_s);

/// [cos, sin] of 2 pi f t: readings x 2.
Eigen::MatrixXd Tone(const Eigen::VectorXd& time_s, double frequency_Hz);

/// Zero before the reading of that number, one from there on; between two numbers in proportion, so that a search
/// may move it.
Eigen::VectorXd Step(const std::vector<int>& reading, double at_reading);

/// cos(k pi share) / k^falling for k = 1, 2, ...: readings x count.
Eigen::MatrixXd CosineModes(const Eigen::VectorXd& share, int count, bool falling);

/// Time since the first reading of the set-up and phase [s].
Eigen::VectorXd SinceFirst_s(const Course& course);

// --- temperature ---

bool HasTemperature(const Course& course);

/// Above a reference [K]. A reading without one keeps that of the reading before; the first ones are at reference.
Eigen::VectorXd Above_K(const Course& course, double reference_degC);

/// What follows a quantity with a lag of first order; it starts in equilibrium, the quantity goes straight from
/// reading to reading.
Eigen::VectorXd Lagged(const Eigen::VectorXd& time_s, const Eigen::VectorXd& followed, double lag_s);

// --- motion ---

/// Recorded direction, +1 or -1; at rest that of the last motion.
Eigen::VectorXd HeldDirection(const Course& course);

/// Typical way from one reading to the next of the same pass; readings at rest do not count. 0 if all are.
double TypicalStep_rad(const Course& course, const Eigen::VectorXd& angle_rad);

/// The largest whole order that readings so far apart show, no more than `most`: two readings a period and a little
/// more, for at exactly two the sine may vanish at every stop. 0 for a step of 0.
int HighestOrder(double step_rad, int most = 120);

}  // namespace twinbench::model
