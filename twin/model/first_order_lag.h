#pragma once

namespace twinbench::model {

/// What follows a quantity with a lag of first order: it starts in equilibrium, the quantity goes straight from one
/// instant to the next.
class FirstOrderLag {
 public:
  /// @param lag_s  0: follows at once.
  explicit FirstOrderLag(double lag_s) : lag_s_(lag_s) {}

  /// As if the quantity had changed at this rate ever since.
  void BeginInMotion(double time_s, double quantity, double rate);

  /// @param time_s  Running forwards.
  /// @return what follows, in the unit of the quantity.
  double Next(double time_s, double quantity);

 private:
  double lag_s_;
  double time_s_ = 0.0, quantity_ = 0.0, follower_ = 0.0;
  bool has_begun_ = false;
};

}  // namespace twinbench::model
