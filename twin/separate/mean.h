#pragma once

namespace twinbench::separate {

/// The mean of numbers that come one after the other.
struct Mean {
  double sum = 0.0;
  int count = 0;

  void Add(double value) {
    sum += value;
    ++count;
  }
  double Value() const { return sum / count; }
};

}  // namespace twinbench::separate
