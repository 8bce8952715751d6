#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

namespace twinbench {

/// One cause, one random stream: Stream(seed, "psd_a.noise").
///
/// Counter-based (Philox4x32-10, Salmon et al., SC'11): the n-th number depends only on seed, name and n, so a
/// campaign gives the same bits however it is split, and a stream can be entered anywhere with Seek.
class Stream {
 public:
  Stream(std::uint64_t seed, std::string_view name);

  /// Jumps to the block of four words with this number.
  void Seek(std::uint64_t block);

  std::uint32_t Word();
  double Uniform();  // [0, 1), 53 bits
  double Normal();   // mean 0, standard deviation 1 (Box-Muller, double)
  /// Chi-squared with `degrees` > 0 degrees of freedom (Marsaglia-Tsang).
  double ChiSquared(double degrees);

  /// Fills `out` with independent standard normals, float accuracy, vectorised; bit-identical on every x86-64.
  /// Uses whole blocks: the stream then stands at a block boundary.
  void FillNormals(std::span<float> out);

 private:
  std::array<std::uint32_t, 2> key_;
  std::uint64_t block_ = 0;
  std::array<std::uint32_t, 4> words_{};
  int used_ = 4;
};

}  // namespace twinbench
