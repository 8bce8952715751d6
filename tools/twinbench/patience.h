#pragma once

#include <algorithm>
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

  /// Whether another step of that name, as long as the longest of its kind up to now, ends within that share of the time; else it is
  /// counted among those that are left out. A step lasts until the next one is asked for.
  bool Allows(double share, const std::string& what) {
    End();
    const bool allows = step_began_s_ + longest_s_[what] <= share * cpu_s_;
    if (allows)
      step_ = what;
    else
      ++left_out_[what];
    return allows;
  }
  /// A step that is taken in any case, and says how long others of that name may take.
  void Takes(const std::string& what) {
    End();
    step_ = what;
  }
  const std::map<std::string, int>& left_out() const { return left_out_; }

 private:
  /// Of the step so far; the next one would begin now.
  void End() {
    const double taken_s = static_cast<double>(std::clock() - began_) / CLOCKS_PER_SEC;
    if (!step_.empty()) longest_s_[step_] = std::max(longest_s_[step_], taken_s - step_began_s_);
    step_.clear();
    step_began_s_ = taken_s;
  }

  double cpu_s_ = std::numeric_limits<double>::infinity();
  std::clock_t began_ = std::clock();
  std::map<std::string, int> left_out_;
  std::map<std::string, double> longest_s_;
  std::string step_;
  double step_began_s_ = 0.0;
};

}  // namespace twinbench::tools
