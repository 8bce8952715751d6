#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "twin/diagnose/engine/linear_run.h"

/// The circumstances of a run as numbers that residuals can be compared with.
namespace twinbench::diagnose::screen {

/// True if a quantity was recorded with (nearly) every reading and is not always the same.
bool Varies(const Eigen::VectorXd& values);

/// Values mapped onto [-1, 1] by their extremes; what was not recorded becomes 0.
Eigen::VectorXd Normalised(const Eigen::VectorXd& values);

/// What was not recorded becomes 0.
Eigen::MatrixXd Recorded(const Eigen::MatrixXd& values);

/// Equal keys get equal numbers, 0, 1, ... in order of appearance.
template <typename Key>
std::vector<int> Numbered(const std::vector<Key>& keys) {
  std::map<Key, int> number;
  std::vector<int> of;
  for (const Key& key : keys) of.push_back(number.try_emplace(key, static_cast<int>(number.size())).first->second);
  return of;
}

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

/// Cosine and sine side by side; 0 where the phase was not recorded.
Eigen::MatrixXd Wave(const Eigen::VectorXd& phase_rad);

/// Channels that are the two coordinates of one light spot: "psd_a_x" and "psd_a_y".
struct Spot {
  std::string name;  // "psd_a"
  int x = 0, y = 0;  // channels
};
std::vector<Spot> SpotsOf(const LinearRun& run);

/// Where the model puts the reading of a channel: without the reading's own noise. Readings long.
Eigen::VectorXd Predicted(const LinearRun& run, int channel);

}  // namespace twinbench::diagnose::screen
