#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace twinbench::imports {

/// How a device goes with its reference over a whole recording.
struct Following {
  double gain = 0.0;         // device per reference, least squares
  double correlation = 0.0;  // -1 to 1
  std::size_t rows_later = 0;  // that the device is behind
  bool is_line = false;        // one gain says it all: another unit or a gear. Play, stiction and a slow servo leave no line
};

/// Jumps of whole turns in either are taken out if that makes them agree better; of a command that waits for the
/// device only the arrivals count, likewise.
Following FollowingOf(const std::vector<double>& reference, const std::vector<double>& shown);

/// The same for a device that comes later, by a quarter of the recording at most (LagOf). Nothing (0 and 0) where it does not.
Following FollowingLater(const std::vector<double>& reference, const std::vector<double>& shown);

/// What a gain far from 1 looks like, "one of them is in rad, the other in deg"; empty if it is no known ratio.
std::string MeaningOfGain(double gain);

/// That ratio itself with the gain's sign, without an error of a scale; the gain where it is none.
double NominalGain(double gain);

}  // namespace twinbench::imports
