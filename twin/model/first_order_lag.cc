#include "twin/model/first_order_lag.h"

#include <algorithm>
#include <cmath>

namespace twinbench::model {

void FirstOrderLag::BeginInMotion(double time_s, double quantity, double rate) {
  has_begun_ = true;
  time_s_ = time_s;
  quantity_ = quantity;
  follower_ = quantity - rate * lag_s_;
}

double FirstOrderLag::Next(double time_s, double quantity) {
  if (lag_s_ <= 0.0 || !has_begun_) {
    follower_ = quantity;
  } else {
    const double elapsed_s = std::max(time_s - time_s_, 1e-9);
    const double behind = (quantity - quantity_) / elapsed_s * lag_s_;  // on a steady slope
    const double transient = follower_ - quantity_ + behind;
    follower_ = quantity - behind + transient * std::exp(-elapsed_s / lag_s_);
  }
  has_begun_ = true;
  time_s_ = time_s;
  quantity_ = quantity;
  return follower_;
}

}  // namespace twinbench::model
