#pragma once

#include <map>
#include <string>
#include <vector>

#include "twin/import/map.h"
#include "twin/import/recording.h"

/// The quantities of the bench on one clock.
namespace twinbench::imports {

/// Rows of one set-up: what was read side by side, on the clock of the device under test.
struct Session {
  std::string name;
  bool has_clock = false;
  std::vector<double> time_s;                        // from the session's first row on the run's clock
  std::map<std::string, std::vector<double>> value;  // by column of the bench, SI; NaN where there is none
  std::size_t Rows() const { return time_s.size(); }
};

struct Joined {
  std::vector<Session> sessions;
  std::vector<LeftOut> left_out;
  std::vector<std::string> remarks;
  std::map<std::string, std::string> unit;  // that counted, by column of the bench
  bool linear = false;                      // lengths were given for angles
  double turn_m = 0.0;                      // of a linear axis
};

/// Evaluates the map's columns on the recordings. Columns with clocks of their own are taken to the clock of the
/// first column that `shown` (the device under test) is made of: linearly between two rows, not across gaps where
/// the values differ; a value that is written down when it changes holds until shortly before the next. What starts
/// again at a turn is unwrapped before it is taken to another clock.
/// @throws InputError if a name is in no file or in several, if clocks do not overlap, or if nothing is left.
Joined Join(const std::vector<Recording>& recordings, const Map& map, const std::string& shown);

/// "2:angle" where both of two files have an "angle", else "angle".
std::string FullName(const std::string& column, const Recording& recording, const std::vector<Recording>& recordings);

/// Every column there is, for messages: "1:angle".
std::string ColumnNames(const std::vector<Recording>& recordings);

}  // namespace twinbench::imports
