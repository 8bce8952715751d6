#pragma once

namespace twinbench {

/// A Simulation that can be another run of the same bench, as Scenario::repeat counts them: chance differs, the bench
/// itself does not.
class NumberedRuns {
 public:
  virtual ~NumberedRuns() = default;
  /// From the next restart on.
  virtual void BeRun(int repeat) = 0;
};

}  // namespace twinbench
