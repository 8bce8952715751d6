#pragma once

#include <cstddef>
#include <vector>

#include "twin/import/rests.h"

/// A command that rests while the device is pushed to and fro within its play. Nobody wrote down which way; it is
/// seen in the device alone, which then stands on one of two sides and hardly between them.
namespace twinbench::imports {

struct Pushed {
  std::vector<std::size_t> rows;  // of the places where that is so, from where the device had come there
  std::vector<int> direction,
      pass;  // of each of them: each stay on one side is a pass that was approached from there
};

/// @param shown     What the device shows [rad], whole turns aside where `turn_rad` is positive.
/// @param rests     Of the command.
/// @return nothing if the device is pushed nowhere.
Pushed PushedIn(const Course& course, const std::vector<Rest>& rests, const std::vector<double>& shown,
                double turn_rad);

}  // namespace twinbench::imports
