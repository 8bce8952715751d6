#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "twin/core/stream_kernel.h"

namespace twinbench {

/// One cause, one random stream: Stream(seed, "psd_a.noise").
///
/// Counter-based (Philox4x32-10, Salmon et al., SC'11): the n-th number depends only on seed, name and n, so a
/// campaign gives the same bits however it is split, and a stream can be entered anywhere with Seek. The key is a
/// 64-bit hash of seed and name, the counter the number of the block. No function of the mathematics library has a
/// part in a value, so the bits do not depend on compiler, library or processor either.
class Stream {
 public:
  Stream(std::uint64_t seed, std::string_view name);

  /// Jumps to the block of four words with this number.
  void Seek(std::uint64_t block);
  /// The block that FillNormals would start with.
  std::uint64_t NextBlock() const { return block_; }

  std::uint32_t Word();
  double Uniform();  // [0, 1), 53 bits, two words
  /// Mean 0, standard deviation 1 (Box-Muller, double): four words give two of them, the second on the next call.
  /// Seek and FillNormals drop one that waits.
  double Normal();
  /// Chi-squared with `degrees` > 0 degrees of freedom (Marsaglia-Tsang); takes a random number of words.
  /// @throws std::logic_error unless `degrees` is positive and finite.
  double ChiSquared(double degrees);

  /// Fills `out` with independent standard normals, float accuracy, vectorised; bit-identical on every x86-64.
  /// Uses whole blocks: the stream then stands at a block boundary.
  void FillNormals(std::span<float> out);

  /// Chooses the instruction set of FillNormals (the best one unless told); changes the speed, never a bit.
  void UseSimd(Simd simd) { simd_ = simd; }
  Simd simd() const { return simd_; }

 private:
  double Gamma(double shape);

  PhiloxKey key_;
  std::uint64_t block_ = 0;
  PhiloxBlock words_{};
  int used_ = 4;
  double spare_ = 0.0;
  bool has_spare_ = false;
  Simd simd_ = BestSimd();
};

}  // namespace twinbench
