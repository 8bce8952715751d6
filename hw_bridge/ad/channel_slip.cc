#include "hw_bridge/ad/channel_slip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace twinbench::hw {
namespace {

constexpr int kLeast = 3;        // groups on either side of a change
constexpr int kGroups = 100000;  // at most: a minute's block needs no finer place, and no more memory
using PerChannel = std::array<double, kChannels>;
using ScanOrder = std::array<std::size_t, kChannels>;

/// Codes of each place in the scan against the mean of the scan, summed up to each group of `stride` scans.
class Block {
 public:
  Block(std::span<const std::int16_t> raw, const ScanOrder& order) : order_(order) {
    const auto scans = static_cast<int>(raw.size()) / kChannels;
    stride_ = (scans + kGroups - 1) / kGroups;
    groups_ = scans / stride_;
    sums_.reserve(static_cast<std::size_t>(groups_) + 1);
    for (int scan = 0; scan < groups_ * stride_; ++scan) {
      if (scan % stride_ == 0) sums_.push_back(sum_);
      Add(raw.subspan(static_cast<std::size_t>(scan) * kChannels, kChannels), scan);
    }
    sums_.push_back(sum_);
  }
  int groups() const { return groups_; }
  int stride() const { return stride_; }
  /// Sum over groups from first to before last.
  PerChannel Sum(int first, int last) const {
    PerChannel sum{};
    for (int c = 0; c < kChannels; ++c) sum[c] = sums_[last][c] - sums_[first][c];
    return sum;
  }
  /// What a straight line through each place takes off the sum of squares, beyond the mean.
  double RampGain() const {
    const double n = 1.0 * groups_ * stride_;
    double gain = 0.0;
    for (int c = 0; c < kChannels; ++c) {
      const double slope = weighted_[c] - 0.5 * (n - 1.0) * sum_[c];
      gain += n < 2.0 ? 0.0 : slope * slope / (n * (n * n - 1.0) / 12.0);
    }
    return gain;
  }

 private:
  void Add(std::span<const std::int16_t> scan, double number) {
    const double common = (scan[0] + scan[1] + scan[2] + scan[3]) / double{kChannels};
    for (int c = 0; c < kChannels; ++c) {
      const double code = scan[order_[c]] - common;
      sum_[c] += code;
      weighted_[c] += number * code;
    }
  }

  ScanOrder order_;
  int stride_ = 1, groups_ = 0;
  PerChannel sum_{};
  std::vector<PerChannel> sums_;
  PerChannel weighted_{};  // sum of scan number times code
};

double SquaresOver(const PerChannel& sum, double n) {
  double squares = 0.0;
  for (const double s : sum) squares += s * s;
  return squares / n;
}

/// Sums behind the change, each put to the place that it came from.
PerChannel TurnedBack(const PerChannel& sum, int places) {
  PerChannel back{};
  for (int c = 0; c < kChannels; ++c) back[(c + places) % kChannels] = sum[c];
  return back;
}

PerChannel Added(const PerChannel& a, const PerChannel& b) {
  PerChannel sum{};
  for (int c = 0; c < kChannels; ++c) sum[c] = a[c] + b[c];
  return sum;
}

struct Change {
  double gain = 0.0;       // taken off the sum of squares, beyond a mean a place
  double free_gain = 0.0;  // the same by any change at that scan
  double exchanged = 0.0;  // largest difference between the means of two places that were exchanged
};

/// The group of the change itself may be mixed and is left out.
Change Judge(const Block& block, int group, int places) {
  const double stride = block.stride(), n = stride * (block.groups() - 1);
  const PerChannel before = block.Sum(0, group), after = block.Sum(group + 1, block.groups());
  const double unchanged = SquaresOver(Added(before, after), n);
  const PerChannel all = Added(before, TurnedBack(after, places));
  Change change{SquaresOver(all, n) - unchanged, 0.0, 0.0};
  change.free_gain =
      SquaresOver(before, stride * group) + SquaresOver(after, stride * (block.groups() - group - 1)) - unchanged;
  for (int c = 0; c < kChannels; ++c) {
    const double difference = (all[c] - all[(c + places) % kChannels]) / n;
    change.exchanged = std::max(change.exchanged, std::abs(difference));
  }
  return change;
}

/// What a change must show, in squared codes; the ramp's gain comes on top.
struct Needed {
  double gain = 0.0;
  double ramp_gain = 0.0;
  double any_change = 0.0;
};

bool IsSlip(const Change& change, const Needed& needed) {
  return change.gain > needed.gain && change.gain - needed.ramp_gain > needed.gain &&
         change.free_gain - change.gain < needed.any_change && change.exchanged >= kLeastSlip_lsb;
}

double NeededForGroups(int groups, double false_alarms) {
  return 2.0 * std::log((kChannels - 1.0) * groups / false_alarms);
}

int ScansAGroup(int scans) {
  return (scans + kGroups - 1) / kGroups;
}

}  // namespace

double NeededForSlip(int scans, double false_alarms) {
  return NeededForGroups(scans / ScansAGroup(scans), false_alarms);
}

ChannelSlip FindChannelSlip(std::span<const std::int16_t> raw, const std::array<std::size_t, kChannels>& scan_order,
                            double noise_lsb, double false_alarms) {
  constexpr double kAnyChange = 40.0;  // chi-squared of 4: exceeded in 4e-8 of all slips
  const Block block(raw, scan_order);
  const double variance = noise_lsb * noise_lsb;
  const Needed needed{NeededForGroups(block.groups(), false_alarms) * variance,
                      block.RampGain(), kAnyChange * variance};
  ChannelSlip found;
  double most = 0.0;
  for (int group = kLeast; group + 1 + kLeast <= block.groups(); ++group) {
    for (int places = 1; places < kChannels; ++places) {
      const Change change = Judge(block, group, places);
      if (change.gain <= most || !IsSlip(change, needed)) continue;
      found = {group * block.stride(), places};
      most = change.gain;
    }
  }
  return found;
}

}  // namespace twinbench::hw
