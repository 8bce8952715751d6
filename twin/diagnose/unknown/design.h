#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "twin/diagnose/engine/family.h"
#include "twin/diagnose/engine/linear_run.h"
#include "twin/diagnose/engine/time_series.h"
#include "twin/model/course.h"

/// Structure without a name: the same generic shapes on every bench, along whatever it has of angles, directions,
/// speeds, temperatures and readings.
namespace twinbench::diagnose::unknown {

/// Channels on which structure may show together.
struct Place {
  std::string name;         // "tilt"
  std::string words;        // "psd_a_y, psd_b_y in phase (tilt pattern)"
  Eigen::MatrixXd pattern;  // channels x amplitudes of their own; largest weight 1
};

/// An angle that structure may be locked to.
struct Angle {
  std::string name;                 // "reference angle"
  Eigen::VectorXd rad;              // one a sample
  int last_order = 0;               // the largest whole order that the samples show
  int first_unfree = 0;             // the first whole order that no unknown of the run takes up; 0: there is none
  std::string harmonics;            // sort of its whole orders
  std::string by;                   // name of the angle in a signal of the twin; empty: it has none
  bool is_turned_by_motion = true;  // false: direction and speed are of another angle
  int first_by_label = 1;           // the first order that is more than a piece of a curve: one that may differ from pass to pass
  std::vector<int> orders = {};     // that are tried, ascending; empty: all from `first_unfree` to `last_order`
};

/// All that generic shapes depend on. Signals have one entry a sample; what a bench has not is empty.
struct Design {
  model::Course course;
  std::vector<std::string> channels;
  std::vector<Place> places;
  std::vector<Angle> angles;            // the first is the one that the bench goes through; may be none
  Eigen::VectorXd continued_rad;        // the first with its turns counted on
  Eigen::VectorXd moved;                // 1 on the way through the positions, 0 elsewhere
  std::vector<Eigen::VectorXd> senses;  // in which a reading may remember the direction; the usual one first
  Eigen::VectorXd travel_rad;           // since the last reversal
  Eigen::VectorXd velocity;             // while it is read
  Eigen::VectorXd above_K;              // temperature
  bool twin_is_warm = false;            // the bench's twin knows that temperature
  TimeSeries series;
  Eigen::MatrixXd shown;                    // samples x channels, as predicted, where errors may depend on it
  std::string shown_name;                   // "spot", "reading"
  std::vector<std::vector<int>> detectors;  // channels that one detector has
  std::string unit;
  double to_SI = 1.0;
  std::vector<ChannelUnit> units;  // of each channel where they are unlike; empty: all are told in `unit`
  Eigen::VectorXd scale;           // where they are unlike: what is alike on all channels, SI; empty: one on each
  double plausible = 0.0;          // rms of a structure nobody thought of, SI, or times `scale`
  double plausible_share = 0.0;    // the same of what is shown
  bool may_be_touched = false;     // something may act for a while and go away again
  std::map<std::string, std::string> named;  // sorts that the catalogue has exactly; the effect, if it is just one, by place
  ToRows rows;

  double ScaleOf(Eigen::Index channel) const { return scale.size() > 0 ? scale[channel] : 1.0; }
  /// The largest that is shown by any channel with the unit of this one.
  double RangeOf(int channel) const;
};

/// One sort of shape after the other; families own what they need.
std::vector<Family> Families(const Design& design);

/// Where time is the angle in other words, what follows one follows the other.
bool TimeFollowsAngle(const Design& design);
/// Turns of the first angle that the course goes through.
double TurnsOf(const Design& design);

}  // namespace twinbench::diagnose::unknown
