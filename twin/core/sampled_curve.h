#pragma once

#include <string>
#include <vector>

namespace twinbench {

/// A curve known at places in increasing order: straight between them, level beyond the first and the last one
/// (what was never seen is not extrapolated).
class SampledCurve {
 public:
  SampledCurve() = default;
  /// @param at  Increasing. @param value  As many.
  SampledCurve(std::vector<double> at, std::vector<double> value);

  bool IsEmpty() const { return at_.empty(); }
  /// Not to be asked of an empty one.
  double At(double place) const;

 private:
  std::vector<double> at_, value_;
};

/// A column of a CSV file and what its numbers are multiplied by.
struct CurveColumn {
  std::string name;
  double to_SI = 1.0;
};

/// @throws InputError if the file cannot be read, lacks a column, has no rows or the places do not increase.
SampledCurve ReadSampledCurve(const std::string& path, const CurveColumn& at, const CurveColumn& value);

}  // namespace twinbench
