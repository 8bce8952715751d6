#pragma once

#include "tests/hidden/twin_cases.h"

/// What causes that the catalogue lacks write into the readings of a run that is otherwise clean.
namespace twinbench::hidden {

/// What an unlisted cause adds to each reading and channel [m or rad], up to its size.
struct UnlistedSignal {
  std::vector<std::string> locks;     // a right signature has one of these words
  std::vector<std::string> channels;  // that it acts on; of the angle bench none
  Eigen::MatrixXd signal;             // readings x channels
};

/// Readings with the random stream of one case, and the one of what is another in every run: where a draught goes.
struct Draw {
  const std::vector<Reading>& readings;
  Stream& stream;
  Stream& of_run;

  int Whole(int first, int last) const { return first + static_cast<int>(stream.Uniform() * (last - first + 1)); }
  double Phase() const { return 2.0 * units::kPi * stream.Uniform(); }
  std::size_t Channel() const { return static_cast<std::size_t>(Whole(0, kChannels - 1)); }

  double Hours(std::size_t i) const;      // since the first reading
  double StepHours(std::size_t i) const;  // since the reading before; of the first: 0
  double Spot_m(std::size_t i, std::size_t channel) const;

  /// value(i) of each reading, in their order.
  using Value = std::function<double(std::size_t i)>;
  using Angle = double Reading::*;
  Value DirectionMap(Angle angle, int first_order, int last_order) const;  // direction times a wave
  Value LineBetween(Angle angle, int first_order, int last_order) const;   // a wave whose order is no whole number
  Value Wander(double from_min, double to_min) const;  // straight between random levels so many minutes apart
  Eigen::VectorXd Series(const Value& value) const;
  Eigen::VectorXd FullCircleSeries(const Value& value) const;  // 0 in the other phases
};

/// Of the rotary bench.
/// @param pattern  "yaw", "tilt", "roll" or the name of a channel.
UnlistedSignal OnPattern(const std::string& pattern, const std::vector<std::string>& locks,
                         const Eigen::VectorXd& series);
UnlistedSignal OnChannel(std::size_t channel, const std::vector<std::string>& locks, const Eigen::VectorXd& series);

/// Of a bench whose scores do not ask for the channel: on the one of that number.
UnlistedSignal OnColumn(Eigen::Index channel, Eigen::Index channels, const std::vector<std::string>& locks,
                        const Eigen::VectorXd& series);

struct UnlistedCause {
  std::string name;
  UnlistedSignal (*draw)(const Draw& draw);
};
const std::vector<UnlistedCause>& UnlistedCausesOf(const std::string& bench);
const std::vector<UnlistedCause>& RotaryUnlistedCauses();

/// Causes that the catalogue lacks, written into the readings of a run that is otherwise clean: `magnitudes` x
/// `seeds` cases of each.
std::vector<Plan> UnlistedPlans(const std::string& bench, const TwinOptions& options);

}  // namespace twinbench::hidden
