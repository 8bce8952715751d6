#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <functional>
#include <string>
#include <vector>

#include "twin/core/errors.h"
#include "twin/model/course.h"

namespace twinbench {
struct Scenario;
}

/// A run as the engine sees it: no bench, only readings x channels, what the model predicted, and which directions
/// of the data the free unknowns can absorb.
namespace twinbench::diagnose {

/// A row whose prediction has a larger variance than this, in units of the row's noise, is not judged by it.
inline constexpr double kDeterminedVariance = 100.0;

using Schedule = model::Course;  // of the used readings

/// A way in which a body's motion shows in all channels of one reading: yaw of the grating, lateral shift, ...
struct Pattern {
  std::string name;        // "yaw", "tilt", "roll", "lateral"; or a channel's name
  Eigen::VectorXd weight;  // one a channel: shown there per SI unit of the pattern
};

/// Unknowns that are always free: table errors, mounting constants, calibrated parameters with priors.
///
/// The first `blocks` x `block_size` unknowns are local: no reading touches two blocks, so they are eliminated by
/// Schur complement. Every unknown has a prior precision (a weak one keeps gauge directions finite).
struct Nuisance {
  Eigen::SparseMatrix<double, Eigen::RowMajor> jacobian;  // rows x unknowns, as raw as the residual
  Eigen::VectorXd prior_precision;                        // 1 / sd^2, one an unknown, all positive
  int blocks = 0;
  int block_size = 0;
  Eigen::VectorXd at = {};  // where the jacobian was taken, from the middle of the priors; empty: there
};

/// What values of a channel are told in.
struct ChannelUnit {
  std::string name;    // "V"
  double to_SI = 1.0;  // factor from there to SI
};

/// What another scenario leaves of a run's readings [SI, by row] where the free unknowns have moved `by` from where the
/// jacobian was taken; what they do by the jacobian is put back. One prediction: no slopes are asked for.
using LeftWhere = std::function<Eigen::VectorXd(const Eigen::VectorXd& by)>;
/// That of the run's own twin set to another scenario; none if that has other unknowns.
/// @throws InputError if it cannot be followed.
using LeftByAnother = std::function<LeftWhere(const Scenario& other)>;

/// Row of reading i (of the schedule) and channel c: i * channels + c.
struct LinearRun {
  std::string bench;  // its name: of the catalogue that names the causes
  Schedule schedule;
  std::vector<std::string> channels;  // "psd_a_x", ...; "angle" on an angle bench
  std::string unit;                   // of values in reports: "um", "arcsec", "deg"
  double to_SI = 1.0;                 // factor from `unit` to SI
  std::vector<ChannelUnit> units;     // of each channel where they are unlike; empty: all are told in `unit`
  double outlier_per_noise = kNaN;    // SI of the catalogue's size of outliers; NaN: it is that of a reading
  Eigen::VectorXd observed;           // SI, by row
  Eigen::VectorXd residual;  // observed - prediction without further effects, unknowns as their priors say, SI
  Eigen::VectorXd sigma;     // stated standard uncertainty of each row, SI
  bool sigma_stated = true;  // false: sigma is an estimate from the data itself
  Eigen::MatrixXd draws = {};  // rows x draws: what one deviation of each shows, part of sigma; all channels of a
                               // reading show the same one. Empty: rows are independent
  double rounding = 0.0;     // SI: step to which the readings are rounded, found in them; 0: none
  bool noise_free = false;   // a simulation without noise: its residuals say nothing about sigma
  Nuisance nuisance;
  std::vector<Pattern> patterns;
  std::vector<int> place = {};  // by row (repeats.h); empty: no place was visited again
  LeftByAnother left_by_another = {};  // none: another scenario makes another run

  /// Best prediction, SI. Regress on this, never on `observed`: that has the residual in it.
  Eigen::VectorXd Predicted() const {
    if (nuisance.at.size() == 0) return observed - residual;
    return observed - residual + nuisance.jacobian * nuisance.at;
  }
  bool IsMixed() const { return !units.empty(); }
  ChannelUnit UnitOf(int channel) const {
    return IsMixed() ? units[static_cast<std::size_t>(channel)] : ChannelUnit{unit, to_SI};
  }
  int Rows() const { return static_cast<int>(residual.size()); }
  int Channels() const { return static_cast<int>(channels.size()); }
  int ReadingOf(int row) const { return row / Channels(); }
  int ChannelOf(int row) const { return row % Channels(); }
};

}  // namespace twinbench::diagnose
