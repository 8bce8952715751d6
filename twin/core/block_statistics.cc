#include "twin/core/block_statistics.h"

#include <algorithm>
#include <cmath>

#include "twin/core/errors.h"

namespace twinbench {
namespace {

__extension__ using Wide = __int128;  // n times a sum of squares does not fit into 64 bits

}  // namespace

ChannelBlock StatisticsOf(const CodeMoments& m, double lsb_V) {
  const auto n = static_cast<double>(m.n);
  const auto sum = static_cast<double>(m.base * m.n + m.deviation);
  // n sum (d^2) - (sum d)^2 is n (n - 1) times the variance and does not depend on the base.
  const Wide spread = Wide{m.n} * m.square - Wide{m.deviation} * m.deviation;
  return {.mean_V = lsb_V * (sum / n),
          .std_V = m.n < 2 ? kNaN : lsb_V * std::sqrt(static_cast<double>(spread) / (n * (n - 1.0))),
          .min_V = lsb_V * static_cast<double>(m.lowest),
          .max_V = lsb_V * static_cast<double>(m.highest)};
}

CodeMoments MomentsOf(std::span<const std::int16_t> raw, int channels, int channel) {
  Require(channels > 0 && raw.size() >= static_cast<std::size_t>(channels), "a block has at least one scan");
  const auto step = static_cast<std::size_t>(channels);
  CodeMoments m;
  m.base = m.lowest = m.highest = raw[static_cast<std::size_t>(channel)];
  for (std::size_t i = static_cast<std::size_t>(channel); i < raw.size(); i += step) {
    const std::int64_t code = raw[i], d = code - m.base;
    ++m.n;
    m.deviation += d;
    m.square += d * d;
    m.lowest = std::min(m.lowest, code);
    m.highest = std::max(m.highest, code);
  }
  return m;
}

}  // namespace twinbench
