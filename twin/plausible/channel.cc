#include "twin/plausible/channel.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "twin/core/distributions.h"

namespace twinbench::plausible {

double ValueOf(const ReadingColumn& column, const Reading& reading) {
  Reading copy = reading;
  return column.number(copy);
}

Channel ChannelOf(const std::vector<Reading>& readings, const ReadingColumn& column) {
  Channel channel{&column, {}, {}};
  for (const Reading& reading : readings) {
    const double value = ValueOf(column, reading);
    if (!std::isfinite(value)) continue;
    channel.reading.push_back(&reading);
    channel.value.push_back(value);
  }
  return channel;
}

std::vector<Channel> ShownChannels(const std::vector<Reading>& readings, const BenchFormat& bench) {
  std::vector<Channel> channels;
  for (const ReadingColumn& column : bench.columns) {
    if (!column.IsShown() || !column.number) continue;
    Channel channel = ChannelOf(readings, column);
    if (channel.size() > 0) channels.push_back(std::move(channel));
  }
  return channels;
}

std::string Text(const ReadingColumn& column, double value) {
  Reading reading;
  column.number(reading) = value;
  return fmt::format("{} = {}", column.name, column.print(reading));
}

bool Moves(const Channel& channel) {
  return std::ranges::any_of(channel.value, [&](double x) { return x != channel.value[0]; });
}

double StepOf(const Channel& channel) {
  const std::set<double> different(channel.value.begin(), channel.value.end());
  if (different.size() < 2) return 0.0;
  double step = INFINITY;
  for (auto at = std::next(different.begin()); at != different.end(); ++at) step = std::min(step, *at - *std::prev(at));
  const auto off = std::ranges::count_if(different, [&](double x) {
    const double multiples = (x - *different.begin()) / step;
    return std::abs(multiples - std::round(multiples)) > 0.02;
  });
  return 100 * off <= std::ssize(different) ? step : 0.0;
}

double LeastScatterOf(const Channel& channel) {
  constexpr double kOfDigits = 1e-12;  // some thousand times the last bit: sums and remainders have lost a few
  return kOfDigits * std::abs(*std::ranges::max_element(channel.value, {}, [](double x) { return std::abs(x); }));
}

std::vector<double> Sizes(std::vector<double> x) {
  for (double& one : x) one = std::abs(one);
  return x;
}

double MiddleOf(std::vector<double> x) {
  return x.empty() ? 0.0 : Median(std::move(x));
}

std::vector<Pair> Neighbours(const Channel& channel) {
  std::vector<Pair> pairs;
  for (std::size_t i = 1; i < channel.size(); ++i) {
    const Reading &before = *channel.reading[i - 1], &here = *channel.reading[i];
    if (here.phase == before.phase && here.setup == before.setup && here.pass == before.pass) pairs.emplace_back(i - 1, i);
  }
  return pairs;
}

std::vector<Pair> Repeats(const Channel& channel) {
  std::map<std::tuple<Phase, int, int>, std::size_t> last;
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < channel.size(); ++i) {
    const Reading& here = *channel.reading[i];
    const auto [entry, is_new] = last.try_emplace({here.phase, here.setup, here.position}, i);
    if (!is_new) pairs.emplace_back(std::exchange(entry->second, i), i);
  }
  return pairs;
}

std::vector<double> Between(const std::vector<Pair>& pairs, const std::vector<double>& value) {
  std::vector<double> differences;
  for (const auto& [first, second] : pairs) differences.push_back(value[second] - value[first]);
  return differences;
}

}  // namespace twinbench::plausible
