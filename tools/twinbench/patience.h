#pragma once

#include <ctime>
#include <limits>
#include <map>
#include <string>

namespace twinbench::tools {

/// CPU time that may be taken, and what is left out for want of it: what matters most is asked first.
class Patience {
 public:
  /// Without end, and for so many seconds from here on.
  Patience() = default;
  explicit Patience(double cpu_s) : cpu_s_(cpu_s) {}

  /// Whether that share of the time is still to be had; else `what` is counted among those that are left out.
  bool Allows(double share, const std::string& what) {
    const double taken_s = static_cast<double>(std::clock() - began_) / CLOCKS_PER_SEC;
    if (taken_s <= share * cpu_s_) return true;
    ++left_out_[what];
    return false;
  }
  double cpu_s() const { return cpu_s_; }
  const std::map<std::string, int>& left_out() const { return left_out_; }

 private:
  double cpu_s_ = std::numeric_limits<double>::infinity();
  std::clock_t began_ = std::clock();
  std::map<std::string, int> left_out_;
};

}  // namespace twinbench::tools
