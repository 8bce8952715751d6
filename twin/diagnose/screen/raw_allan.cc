#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/core/stream.h"
#include "twin/diagnose/screen/allan.h"
#include "twin/diagnose/screen/raw_blocks.h"
#include "twin/diagnose/screen/words.h"

namespace twinbench::diagnose::screen {
namespace {

constexpr Eigen::Index kMostNullValues = 8192;  // in a channel of a null run; more blocks only scale the scatter

/// Lengths 2, 4, 8, ... of which a block holds at least four.
std::vector<int> LengthsIn(Eigen::Index samples) {
  std::vector<int> lengths;
  for (int m = 2; 4 * m <= samples; m *= 2) lengths.push_back(m);
  return lengths;
}

double VarianceOver(const Eigen::MatrixXd& blocks, int length) {
  AllanVariance variance(length);
  for (Eigen::Index j = 0; j < blocks.cols(); ++j) variance.Add(blocks.col(j));
  return variance.Value();
}

/// m AVAR(m) / AVAR(1), one entry a length: 1 in white noise, however few the blocks (a logarithm would not be).
Eigen::VectorXd Excess(const Eigen::MatrixXd& blocks, const std::vector<int>& lengths) {
  const double one = VarianceOver(blocks, 1);
  Eigen::VectorXd excess = Eigen::VectorXd::Zero(std::ssize(lengths));
  for (std::size_t k = 0; k < lengths.size() && one > 0.0; ++k)
    excess[static_cast<Eigen::Index>(k)] = lengths[k] * VarianceOver(blocks, lengths[k]) / one;
  return excess;
}

Eigen::MatrixXd WhiteBlocks(Stream& stream, Eigen::Index samples, Eigen::Index blocks) {
  Eigen::MatrixXf white(samples, blocks);
  stream.FillNormals({white.data(), static_cast<std::size_t>(white.size())});
  return white.cast<double>();
}

/// Entry 0: one channel; the others white noise of the same design, their scatter scaled to as many blocks.
Eigen::MatrixXd WithNulls(const Eigen::MatrixXd& blocks, const std::vector<int>& lengths, int null_runs,
                          Stream& stream) {
  const Eigen::Index few = std::clamp<Eigen::Index>(kMostNullValues / blocks.rows(), 1, blocks.cols());
  Eigen::MatrixXd values(std::ssize(lengths), 1 + null_runs);
  values.col(0) = Excess(blocks, lengths);
  for (int j = 1; j <= null_runs; ++j) values.col(j) = Excess(WhiteBlocks(stream, blocks.rows(), few), lengths);
  const Eigen::VectorXd mean = values.rightCols(null_runs).rowwise().mean();
  const double scale = std::sqrt(static_cast<double>(few) / static_cast<double>(blocks.cols()));
  for (int j = 1; j <= null_runs; ++j) values.col(j) = mean + scale * (values.col(j) - mean);
  return values;
}

/// What is there beside white noise, codes.
double Beyond(const Eigen::MatrixXd& blocks, int length) {
  return std::sqrt(std::max(0.0, VarianceOver(blocks, length) - VarianceOver(blocks, 1) / length));
}

}  // namespace

/// Scatter of means against the length that is averaged.
Tests TestRawAllan(const ThinnedBlocks& blocks, const RawScale& scale, int null_runs, std::uint64_t seed) {
  const std::vector<int> lengths = LengthsIn(blocks.Samples());
  const auto count = std::ssize(lengths);
  if (count == 0 || blocks.Blocks() == 0) return {};
  Eigen::MatrixXd values(count * std::ssize(scale.channels), 1 + null_runs);
  std::vector<std::string> names;
  Stream stream(seed, "screen.raw.allan");
  for (std::size_t c = 0; c < scale.channels.size(); ++c) {
    values.middleRows(static_cast<Eigen::Index>(c) * count, count) =
        WithNulls(blocks.channel[c], lengths, null_runs, stream);
    for (int m : lengths)
      names.push_back(fmt::format("means over {:.3g} ms of {}", 1e3 * m / blocks.rate_Hz, scale.channels[c].name));
  }
  auto found = TestMoments(values, names, "raw: Allan deviation", Sides::kUpper);
  if (!found) return {};
  const auto channel = static_cast<std::size_t>(found->item / count);
  const int length = lengths[static_cast<std::size_t>(found->item % count)];
  SetRawEffect(scale.channels[channel], Beyond(blocks.channel[channel], length), found->test);
  found->test.reading = fmt::format(
      "{} scatter more than white noise would: flicker, drift or hum, and more samples do not help as they should",
      names[static_cast<std::size_t>(found->item)]);
  return {std::move(found->test)};
}

}  // namespace twinbench::diagnose::screen
