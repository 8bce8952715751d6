#pragma once

#include <string>
#include <vector>

namespace twinbench::report {

/// Which characters a terminal can show.
enum class Letters { kAscii, kUnicode };

/// A curve over an axis, seen in two directions.
struct CurveText {
  std::string title;                      // "Error of angle [deg]"
  std::string x_name;                     // "angle [deg]"
  std::vector<double> x;                  // ascending
  std::vector<double> forward, backward;  // one an x; NaN: left out. `backward` may be empty
  std::string forward_name = "forward", backward_name = "backward";
};

/// A plot of characters, at most 80 wide and 22 lines high: title, frame with the ends and the middle of both axes,
/// legend. In ASCII `>` is forward, `<` backward and `x` where both meet. In Unicode forward is a line of Braille
/// dots, eight a character, broken where a place is missing; backward a ring `○`, or `●` where it stands on the
/// line.
/// @return "" if there are not two places with a value.
std::string PlotOf(const CurveText& curve, Letters letters);

}  // namespace twinbench::report
