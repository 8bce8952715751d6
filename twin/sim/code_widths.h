#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "twin/sim/ad_sampler_kernel.h"

namespace twinbench::sim {

/// Differential non-linearity of an A/D converter: its codes are not equally wide.
///
/// The edge below code k lies at k - 1/2 + e_k LSB, code k is 1 + e_(k+1) - e_k wide.
class CodeWidths {
 public:
  CodeWidths() = default;
  /// The e_k are independent and uniform, so that the widths have the stated root mean square, no code is missing,
  /// and sums of widths do not run away: what is smooth in the voltage is the integral non-linearity's part.
  /// @param dnl_lsb  Root mean square of the widths less one, at most 0.4; 0: all codes are equally wide.
  /// @param bits     Of the converter, whose codes are -2^(bits-1) .. 2^(bits-1) - 1.
  CodeWidths(double dnl_lsb, int bits, std::uint64_t seed);
  /// The widths as they were measured. They add up from the lower edge of code 0, which lies where it should; what
  /// they add up to is an integral non-linearity.
  /// @param excess_lsb  By code, how much wider than one LSB it is; -1 is a code that is missing.
  CodeWidths(const std::map<std::int32_t, double>& excess_lsb, int bits);

  bool AreEqual() const { return off_lsb_.empty(); }
  /// How far the edge below a code lies from where it should; beyond the end codes as at the last edge.
  float Off_lsb(std::int32_t code) const;
  /// Code of a voltage.
  /// @param base   A code near it.
  /// @param x_lsb  The voltage from there.
  std::int32_t CodeOf(std::int32_t base, float x_lsb) const;

  /// What the edges add to the mean of the codes of a voltage that scatters normally, [LSB].
  double Shift_lsb(double level_lsb, double noise_lsb) const;

 private:
  std::int32_t lowest_ = 0;
  std::vector<float> off_lsb_;  // one a code, and above the highest
};

/// As Quantise of the kernel, with these edges.
void Quantise(const CodeWidths& widths, const Quantiser& quantiser, std::span<const float> signal,
              std::span<const float> normals, std::span<std::int32_t> codes, CodeSums& sums);

}  // namespace twinbench::sim
