#pragma once

#include <vector>

#include "twin/diagnose/engine/linear_run.h"

/// Which readings share an unknown error: of a position of the turntable, of a tooth, of a sweep.
namespace twinbench::diagnose::turntable {

struct Places {
  /// Local blocks: positions of the turntable within a turn, to a millionth of it; and one for each sweep, whose
  /// small moves are not positions of their own.
  std::vector<int> block;  // of every reading
  int blocks = 0;
  int circle_blocks = 0;          // those of full circles come first
  std::vector<int> tooth;         // of every reading; -1 in a sweep, and where none is told apart
  int teeth = 0;                  // that a shift tells from the positions
  std::vector<int> setup, sweep;  // of every reading, numbered; -1: in a sweep, or in none
  int setups = 0, sweeps = 0;
  std::vector<double> sweep_centre_rad;  // of the turntable, one a sweep
  bool HasTeeth() const { return teeth > 0; }
};

/// A tooth that meets one position only, which meets no other tooth, cannot be told from the position.
Places PlacesOf(const Schedule& schedule);

}  // namespace twinbench::diagnose::turntable
