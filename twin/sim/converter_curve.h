#pragma once

#include <string>
#include <vector>

namespace twinbench::sim {

/// Integral non-linearity of an A/D converter: what it adds to a voltage, straight between the rows of a table and
/// level outside of them. Its data sheet's curve, or a measured one. Structure finer than the noise of a sample is
/// for `adc_step`.
class ConverterCurve {
 public:
  /// @param path  CSV of voltage_V (increasing) and error_mV; empty: none is added.
  /// @throws InputError if it cannot be read or lacks a column or rows.
  explicit ConverterCurve(const std::string& path);

  bool IsStraight() const { return voltage_V_.empty(); }
  double Added_V(double voltage_V) const;

 private:
  std::vector<double> voltage_V_, added_V_;
};

}  // namespace twinbench::sim
