#include "twin/plausible/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "twin/core/errors.h"
#include "twin/core/number_text.h"
#include "twin/core/units.h"

namespace twinbench::plausible {
namespace {

constexpr std::size_t kFewest = 4;          // readings from which anything can be said
constexpr std::size_t kFewestToJudge = 12;  // of a channel
constexpr double kStuckShare = 0.1;         // of the readings in a row with the very same value
constexpr std::size_t kShortestStuck = 10;
constexpr double kContradicted = 0.3;  // of the labels of a run
constexpr double kFastest_rad_s = 1e6 * units::turn / 60.0;  // a million turns a minute: no spindle does

/// One column of numbers, those that are there.
struct Channel {
  const ReadingColumn* column = nullptr;
  std::vector<int> reading;
  std::vector<double> value;  // SI
};

double ValueOf(const ReadingColumn& column, const Reading& reading) {
  Reading copy = reading;
  return column.number(copy);
}

std::vector<Channel> ShownChannels(const std::vector<Reading>& readings, const BenchFormat& bench) {
  std::vector<Channel> channels;
  for (const ReadingColumn& column : bench.columns) {
    if (!column.IsShown() || !column.number) continue;
    Channel channel{&column, {}, {}};
    for (const Reading& reading : readings) {
      const double value = ValueOf(column, reading);
      if (!std::isfinite(value)) continue;
      channel.reading.push_back(reading.reading);
      channel.value.push_back(value);
    }
    if (!channel.value.empty()) channels.push_back(std::move(channel));
  }
  return channels;
}

/// A value as the file has it, with the column's name.
std::string Text(const Channel& channel, double value) {
  Reading reading;
  channel.column->number(reading) = value;
  return fmt::format("{} = {}", channel.column->name, channel.column->print(reading));
}

bool Moves(const Channel& channel) {
  return std::ranges::any_of(channel.value, [&](double x) { return x != channel.value[0]; });
}

void CheckRange(const Channel& channel, double range, std::vector<Finding>& findings) {
  if (!(range > 0.0)) return;
  std::size_t outside = 0, worst = 0;
  for (std::size_t i = 0; i < channel.value.size(); ++i) {
    if (std::abs(channel.value[i]) > 1.001 * range) ++outside;
    if (std::abs(channel.value[i]) > std::abs(channel.value[worst])) worst = i;
  }
  if (outside == 0) return;
  const double ratio = std::abs(channel.value[worst]) / range;
  const char* hint = ratio > 10.0 && ratio < 1100.0 && 2 * outside > channel.value.size() ? "; is it in mV?" : "";
  findings.push_back(
      {true, fmt::format("{} values of {} are outside the converter's range of {:g}, reading {} with {}{}", outside,
                         channel.column->name, range, channel.reading[worst], Text(channel, channel.value[worst]),
                         hint)});
}

/// @param others_move  Another channel shows motion or noise: this one should, too.
void CheckAlive(const Channel& channel, bool others_move, std::vector<Finding>& findings) {
  if (channel.value.size() < kFewestToJudge || !others_move) return;
  if (!Moves(channel)) {
    findings.push_back({true, fmt::format("{} in all {} readings: the channel is dead, or its column is another's",
                                          Text(channel, channel.value[0]), channel.value.size())});
    return;
  }
  std::size_t longest = 1, run = 1, end = 0;
  for (std::size_t i = 1; i < channel.value.size(); ++i) {
    run = channel.value[i] == channel.value[i - 1] ? run + 1 : 1;
    if (run > longest) {
      longest = run;
      end = i;
    }
  }
  const std::set<double> different(channel.value.begin(), channel.value.end());
  const bool coarse = 4 * different.size() < channel.value.size();  // steps of a converter repeat themselves
  if (coarse || longest < kShortestStuck ||
      static_cast<double>(longest) < kStuckShare * static_cast<double>(channel.value.size()))
    return;
  findings.push_back(
      {false, fmt::format("{} stands still at {} for {} readings, up to reading {}: it was stuck",
                          channel.column->name, Text(channel, channel.value[end]), longest, channel.reading[end])});
}

/// The step of which all values are multiples; 0 if there is none.
double StepOf(const Channel& channel) {
  const std::set<double> different(channel.value.begin(), channel.value.end());
  if (different.size() < 2) return 0.0;
  double step = INFINITY;
  for (auto at = std::next(different.begin()); at != different.end(); ++at)
    step = std::min(step, *at - *std::prev(at));
  const auto off = std::ranges::count_if(different, [&](double x) {
    const double multiples = (x - *different.begin()) / step;
    return std::abs(multiples - std::round(multiples)) > 0.02;
  });
  return 100 * off <= std::ssize(different) ? step : 0.0;
}

/// Standard deviation of white noise on a smooth course, from second differences.
double ScatterOf(const std::vector<double>& x) {
  std::vector<double> size;
  for (std::size_t i = 2; i < x.size(); ++i) size.push_back(std::abs(x[i] - 2.0 * x[i - 1] + x[i - 2]));
  if (size.empty()) return 0.0;
  const auto middle = size.begin() + static_cast<std::ptrdiff_t>(size.size() / 2);
  std::ranges::nth_element(size, middle);
  return 1.4826 * *middle / std::sqrt(6.0);
}

/// What a channel shows beside the column that it should follow; itself where there is no such.
std::vector<double> Beside(const Channel& channel, const std::vector<Reading>& readings, const BenchFormat& bench) {
  if (!bench.compared || channel.column->name != bench.compared->shown) return channel.value;
  const auto reference = std::ranges::find(bench.columns, bench.compared->reference, &ReadingColumn::name);
  std::vector<double> beside;
  for (const Reading& reading : readings) {
    const double error = ValueOf(*channel.column, reading) - ValueOf(*reference, reading);
    if (std::isfinite(error)) beside.push_back(std::remainder(error, units::turn));
  }
  return beside;
}

/// A device that was driven by its own readings, from one to the next, has them evenly spaced.
bool AreChosenStops(const Channel& channel) {
  std::vector<double> way;
  for (std::size_t i = 1; i < channel.value.size(); ++i)
    way.push_back(std::abs(channel.value[i] - channel.value[i - 1]));
  const auto middle = way.begin() + static_cast<std::ptrdiff_t>(way.size() / 2);
  std::ranges::nth_element(way, middle);
  const double usual = *middle;
  const auto even = std::ranges::count_if(way, [usual](double w) { return std::abs(w - usual) < 1e-6 * usual; });
  return 10 * even > 9 * std::ssize(way);
}

/// Steps that are larger than what scatters: the scatter is theirs.
void CheckSteps(const Channel& channel, const std::vector<double>& beside, std::vector<Finding>& findings) {
  if (channel.value.size() < kFewestToJudge || channel.column->role != ColumnRole::kShown) return;
  const double step = StepOf(channel);
  if (!(step > 2.0 * ScatterOf(beside)) || AreChosenStops(channel)) return;
  Reading reading;
  channel.column->number(reading) = step;
  const double shown = ParseNumber(channel.column->print(reading)).value_or(kNaN);
  findings.push_back(
      {false, fmt::format("{} comes in steps of {:.6g}: that resolution is the largest part of its noise",
                          channel.column->name, shown)});
}

/// The angle that a bench's positions and directions are labels of; null if it has no such.
const ReadingColumn* LabelledAngle(const BenchFormat& bench) {
  for (const ReadingColumn& column : bench.columns) {
    if (column.role == ColumnRole::kRequired && column.number)
      return column.name.ends_with("_deg") ? &column : nullptr;
  }
  return nullptr;
}

/// Two readings of one pass that have the same position and stand at different angles.
void CheckPositions(const std::vector<Reading>& readings, const ReadingColumn& angle,
                    std::vector<Finding>& findings) {
  std::map<std::tuple<int, int, int>, double> first;  // set-up, pass, position
  std::size_t judged = 0, wrong = 0;
  int example = 0;
  for (const Reading& reading : readings) {
    if (reading.phase != Phase::kFullCircle || reading.direction == 0) continue;
    const double here = ValueOf(angle, reading);
    const auto [entry, is_new] = first.try_emplace({reading.setup, reading.pass, reading.position}, here);
    ++judged;
    if (is_new || std::abs(std::remainder(here - entry->second, units::turn)) < 0.5 * units::deg) continue;
    ++wrong;
    example = reading.reading;
  }
  if (judged < kFewestToJudge || static_cast<double>(wrong) < kContradicted * static_cast<double>(judged)) return;
  findings.push_back(
      {true,
       fmt::format("{} of {} readings have the position of another one of their pass, at another {}; reading {} "
                   "is one of them",
                   wrong, judged, angle.name, example)});
}

/// An angle that nothing turns to in the time since the reading before. The twin would follow it there, step by step.
void CheckSpeed(const std::vector<Reading>& readings, const ReadingColumn& angle, std::vector<Finding>& findings) {
  for (std::size_t i = 1; i < readings.size(); ++i) {
    const double way = ValueOf(angle, readings[i]) - ValueOf(angle, readings[i - 1]);
    const double time_s = std::max(ToSeconds(readings[i].time - readings[i - 1].time), 1.0);  // of clocks that stand
    if (!(std::abs(way) > kFastest_rad_s * time_s)) continue;
    findings.push_back({true, fmt::format("{} is {:.3g} turns from where it was {:.3g} s before, in reading {}", angle.name,
                                          way / units::turn, time_s, readings[i].reading)});
    return;
  }
}

/// The label says which way the angle went.
void CheckDirections(const std::vector<Reading>& readings, const ReadingColumn& angle,
                     std::vector<Finding>& findings) {
  std::size_t judged = 0, wrong = 0;
  for (std::size_t i = 1; i < readings.size(); ++i) {
    const Reading& here = readings[i];
    const Reading& before = readings[i - 1];
    if (here.phase != Phase::kFullCircle || here.setup != before.setup || here.pass != before.pass ||
        here.direction == 0)
      continue;
    const double step = ValueOf(angle, here) - ValueOf(angle, before);
    if (!(std::abs(step) > 1e-9) || std::abs(step) > units::turn / 2.0) continue;
    ++judged;
    if (step * here.direction < 0.0) ++wrong;
  }
  if (judged < kFewestToJudge || static_cast<double>(wrong) < kContradicted * static_cast<double>(judged)) return;
  findings.push_back({false, fmt::format("{} of {} steps of {} go against the direction that the readings say",
                                         wrong, judged, angle.name)});
}

void CheckClock(const std::vector<Reading>& readings, std::vector<Finding>& findings) {
  if (readings.size() < kFewestToJudge || readings.front().time < readings.back().time) return;
  findings.push_back({false, "all readings have the same time: nothing can be said about drifts and delays"});
}

}  // namespace

std::vector<Finding> Check(const std::vector<Reading>& readings, const Scenario& scenario) {
  std::vector<Finding> findings;
  const BenchFormat& bench = FormatOf(scenario.bench);
  const std::vector<Channel> channels = ShownChannels(readings, bench);
  if (readings.size() < kFewest || channels.empty()) {
    findings.push_back({true, fmt::format("there are {} readings, none of which says anything", readings.size())});
    if (!channels.empty()) findings[0].line = fmt::format("there are only {} readings", readings.size());
    return findings;
  }
  const bool others_move =
      !scenario.noise_free &&
      (channels.size() == 1 || std::ranges::count_if(channels, Moves) * 2 >= std::ssize(channels));
  for (const Channel& channel : channels) {
    if (bench.range_of) CheckRange(channel, bench.range_of(scenario, channel.column->name), findings);
    CheckAlive(channel, others_move, findings);
    CheckSteps(channel, Beside(channel, readings, bench), findings);
  }
  if (const ReadingColumn* angle = LabelledAngle(bench)) {
    CheckPositions(readings, *angle, findings);
    CheckDirections(readings, *angle, findings);
  }
  for (const ReadingColumn& column : bench.columns) {
    if (column.role == ColumnRole::kRequired && column.number && column.name.ends_with("_deg"))
      CheckSpeed(readings, column, findings);
  }
  CheckClock(readings, findings);
  std::ranges::stable_sort(findings, {}, [](const Finding& f) { return !f.fatal; });
  return findings;
}

std::string InLines(const std::vector<Finding>& findings) {
  std::string text;
  for (const Finding& finding : findings)
    text += (finding.fatal ? "cannot be: " : "doubtful: ") + finding.line + "\n";
  return text;
}

void RefuseFatal(const std::vector<Finding>& findings, const std::string& where) {
  if (findings.empty() || !findings.front().fatal) return;
  throw InputError(where, findings.front().line, "readings that can be trusted");
}

}  // namespace twinbench::plausible
