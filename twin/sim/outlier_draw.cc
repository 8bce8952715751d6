#include "twin/sim/outlier_draw.h"

#include "twin/sim/effect_parameter.h"

namespace twinbench::sim {

OutlierDraw::OutlierDraw(const EffectSettings& effect, std::uint64_t seed)
    : fraction_(Parameter(effect, "fraction")), size_(Parameter(effect, "size")), seed_(seed) {}

OutlierDraw::Drawn OutlierDraw::At(int reading) const {
  Stream stream(seed_, "effect.outliers");
  stream.Seek(2 * static_cast<std::uint64_t>(reading));  // a block has two numbers, we take four
  if (stream.Uniform() >= fraction_) return {};
  const double sign = stream.Uniform() < 0.5 ? -1.0 : 1.0;
  const double size = sign * size_ * (0.5 + stream.Uniform());
  return {size, stream.Uniform()};
}

}  // namespace twinbench::sim
