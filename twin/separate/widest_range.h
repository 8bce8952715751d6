#pragma once

#include <vector>

namespace twinbench::separate {

/// Normal numbers of one scale.
struct NormalSample {
  double deviation = 0.0;  // standard deviation, >= 0
  int size = 2;
};

/// The largest of several ranges, as a random number.
struct WidestRange {
  double mean = 0.0;
  double deviation = 0.0;  // standard deviation
};

/// Distribution of the largest range (largest less smallest number) of independent normal samples.
///
/// P(widest < w) is the product of each sample's P(range < w) = k int phi(x) (Phi(x + w) - Phi(x))^(k-1) dx (Tippett, Biometrika 17 (1925) 364-387);
/// mean and variance are integrals of it. To 0.1 %; samples x 280 interpolations.
/// @throws std::logic_error if there is no sample, one has fewer than two numbers or no finite deviation.
WidestRange WidestOf(const std::vector<NormalSample>& samples);

}  // namespace twinbench::separate
