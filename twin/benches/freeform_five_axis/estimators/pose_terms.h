#pragma once

#include <functional>

#include "twin/benches/freeform_five_axis/estimators/pose_chain.h"

/// What displaces a ball against the tool, one unknown each, to first order: errors of the axes by their names in
/// ISO 230-1 and ISO 230-7 ("XOC": where the average line of C is along X; "EXC": what X errs as C turns), and how
/// ball and tool are set up.
namespace twinbench::benches::freeform::estimators {

enum class TermKind { kMounting, kTool, kLocation, kSquareness, kComponent, kDrift };

struct PoseTerm {
  TermKind kind = TermKind::kComponent;
  std::string name;         // "XOC", "EXC"; of a mounting and a drift "x"
  std::string unit = "um";  // um | arcsec | um_m
  int order = 0;            // per turn, or of a polynomial of a linear axis or of what has elapsed
  int ball = 0;             // of a mounting
  bool is_sine = false;     // of a rotary axis' component; else its cosine
  bool is_of_linear = false;
  std::function<Eigen::Vector3d(const PosePlace&)>
      slope_um;  // what one unit moves the ball, seen from the tool, in machine axes
  bool is_beyond = false;  // of an order that these poses do not tell from lower ones

  bool IsSetUp() const { return kind == TermKind::kMounting || kind == TermKind::kTool; }
  bool IsLocation() const { return kind == TermKind::kLocation || kind == TermKind::kSquareness; }
  std::string Words() const;
};

/// Those that poses may show, the ones that are taken first where two move the ball alike: set-up, locations,
/// squareness, scales, components of rotary axes by rising order, translations before rotations, and of linear
/// ones. Components of more than `highest_order`, up to `possible_order`, come last, beyond what the poses tell, and
/// drifts from the first reading on.
/// @param is_rigid  What has one number as a ball is a body of many balls, whose place and turn are unknown.
std::vector<PoseTerm> TermsOf(const MachineChain& chain, const std::vector<PosePlace>& places, int highest_order,
                              int possible_order, bool is_rigid);

}  // namespace twinbench::benches::freeform::estimators
