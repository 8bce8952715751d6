#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "twin/diagnose/engine/linear_run.h"
#include "twin/diagnose/screen/screen.h"

/// The circumstances of a run as numbers that residuals can be compared with, and sizes as lengths and angles.
namespace twinbench::diagnose::screen {

/// True if a quantity was recorded with (nearly) every reading and is not always the same.
bool Varies(const Eigen::VectorXd& values);

/// Values mapped onto [-1, 1] by their extremes; what was not recorded becomes 0.
Eigen::VectorXd Normalised(const Eigen::VectorXd& values);

/// What was not recorded becomes 0.
Eigen::MatrixXd Recorded(const Eigen::MatrixXd& values);

/// Cosine and sine side by side; 0 where the phase was not recorded.
Eigen::MatrixXd Wave(const Eigen::VectorXd& phase_rad);

/// Equal keys get equal numbers, 0, 1, ... in order of appearance.
template <typename Key>
std::vector<int> Numbered(const std::vector<Key>& keys) {
  std::map<Key, int> number;
  std::vector<int> of;
  for (const Key& key : keys) of.push_back(number.try_emplace(key, static_cast<int>(number.size())).first->second);
  return of;
}

/// Sums of rows of the same group: groups x columns. Rows of group -1 are left out.
Eigen::MatrixXd SumsByGroup(const Eigen::MatrixXd& rows, const std::vector<int>& group);

/// A place to which the bench comes back: set-up, phase, position, and the angles to 1e-6 rad within a turn.
using PlaceKey = std::vector<long>;
PlaceKey PlaceOfReading(const Schedule& schedule, int reading);

/// Readings of the same pass.
bool SamePass(const Schedule& schedule, int a, int b);

/// Time since the first reading of the same set-up and phase.
Eigen::VectorXd TimeInSetup_s(const Schedule& schedule);

/// An angle that errors may be locked to: target, reference, their sum and difference, as far as they were recorded
/// and vary.
struct AngleArgument {
  std::string name;  // "target angle"
  Eigen::VectorXd angle_rad;
  bool of_a_body = false;  // not the sum or the difference
};
std::vector<AngleArgument> AnglesOf(const LinearRun& run);

/// Orders that the stops can tell apart: up to half the number of different angles within a turn, at most 16.
int HighestOrder(const Eigen::VectorXd& angle_rad);

/// Channels that are the two coordinates of one light spot: "psd_a_x" and "psd_a_y".
struct Spot {
  std::string name;  // "psd_a"
  int x = 0, y = 0;  // channels
};
std::vector<Spot> SpotsOf(const LinearRun& run);

/// Rows of one channel.
inline auto RowsOf(const LinearRun& run, int channel) {
  return Eigen::seqN(channel, run.schedule.Readings(), run.Channels());
}

/// Where the model puts the reading of a channel: without the reading's own noise. Readings long.
Eigen::VectorXd Predicted(const LinearRun& run, int channel);

/// Typical standard uncertainty of a channel's readings, SI.
double TypicalSigma(const LinearRun& run, int channel);

/// Deviation of what comes beside noise of this deviation and makes it `ratio` times as large, or as small.
double Excess(double sigma, double ratio);

/// "0.42 um": a value of a channel's readings in its unit.
std::string Amount(const LinearRun& run, int channel, double value_SI);

/// What a size on one channel amounts to as an angle: of the rotation that moves that channel most, or the size
/// itself where readings are angles; NaN if there is neither.
double AsAngle(const LinearRun& run, int channel, double size_SI);

/// The channel of which a unit of noise is most as an angle: for sizes that belong to no channel.
int AnyChannel(const LinearRun& run);

/// A size on one channel, as a length (NaN where readings are angles) and as an angle; neither where they are
/// neither.
void SetEffect(const LinearRun& run, int channel, double size_SI, ScreenTest& test);

/// The size of a body's motion by its pattern: as a length that of the channel that shows it most.
void SetEffect(const LinearRun& run, const Pattern& pattern, double amplitude, ScreenTest& test);

}  // namespace twinbench::diagnose::screen
