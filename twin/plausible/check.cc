#include "twin/plausible/check.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "twin/core/errors.h"
#include "twin/core/number_text.h"
#include "twin/core/robust_scale.h"
#include "twin/core/units.h"
#include "twin/plausible/channel.h"
#include "twin/plausible/checks.h"

namespace twinbench::plausible {
namespace {

constexpr std::size_t kFewest = 4;   // readings from which anything can be said
constexpr double kStuckShare = 0.1;  // of the readings in a row with the very same value
constexpr std::size_t kShortestStuck = 10;
constexpr double kCoarse = 0.2;     // of the readings elsewhere that are the same as the one before: ten in a row are no chance
constexpr double kFarBeyond = 3.0;  // times the range of an instrument or an axis, which is stated with some reserve

void CheckRange(const Channel& channel, double range, std::vector<Finding>& findings) {
  if (!(range > 0.0)) return;
  std::size_t outside = 0, worst = 0;
  for (std::size_t i = 0; i < channel.size(); ++i) {
    if (std::abs(channel.value[i]) > 1.001 * range) ++outside;
    if (std::abs(channel.value[i]) > std::abs(channel.value[worst])) worst = i;
  }
  if (outside == 0) return;
  const double ratio = std::abs(channel.value[worst]) / range;
  const bool is_converter = channel.column->name.ends_with("_V");
  const char* hint = ratio > 10.0 && ratio < 1100.0 && 2 * outside > channel.size()
                         ? (is_converter ? "; is it in mV?" : "; is it in another unit?")
                         : "";
  findings.push_back({is_converter || ratio > kFarBeyond,
                      fmt::format("{} values of {} are outside the {} range, {}; reading {} with {}{}", outside,
                                  channel.column->name, is_converter ? "converter's" : "stated", Text(*channel.column, range),
                                  channel.reading[worst]->reading, Text(*channel.column, channel.value[worst]), hint)});
}

/// Whether anything else was commanded or shown.
bool AnythingElseMoved(const Reading& before, const Reading& here, const ReadingColumn& besides, const BenchFormat& bench) {
  return std::ranges::any_of(bench.columns, [&](const ReadingColumn& column) {
    const bool is_judged_by = column.number && (column.MustBeThere() || column.may_be_absent) && column.name != besides.name;
    return is_judged_by && std::isfinite(ValueOf(column, here)) && ValueOf(column, before) != ValueOf(column, here);
  });
}

/// Whether a channel should stand where it does, to a step of its own.
bool MayStand(const Reading& before, const Reading& here, const Expected& claim) {
  return claim.nominal && std::abs(claim.nominal(here) - claim.nominal(before)) <= claim.step;
}

/// The very same value in a row while anything else moves.
void CheckStuck(const Channel& channel, const BenchFormat& bench, const Expected& claim, std::vector<Finding>& findings) {
  std::size_t longest = 1, run = 1, end = 0, equal = 0;
  for (std::size_t i = 1; i < channel.size(); ++i) {
    const Reading &before = *channel.reading[i - 1], &here = *channel.reading[i];
    const bool stands = channel.value[i] == channel.value[i - 1] && !MayStand(before, here, claim) &&
                        AnythingElseMoved(before, here, *channel.column, bench);
    equal += stands;
    run = stands ? run + 1 : 1;
    if (run > longest) {
      longest = run;
      end = i;
    }
  }
  const double elsewhere = static_cast<double>(channel.size() - longest), again = static_cast<double>(equal - (longest - 1));
  if (longest < kShortestStuck || static_cast<double>(longest) < kStuckShare * static_cast<double>(channel.size()) ||
      again > kCoarse * elsewhere)  // steps of a converter repeat themselves
    return;
  findings.push_back({2 * longest > channel.size(),
                      fmt::format("{} stands still at {} for {} readings, up to reading {}: it was stuck", channel.column->name,
                                  Text(*channel.column, channel.value[end]), longest, channel.reading[end]->reading)});
}

/// @param moves  Noise of its own, or another channel that shows motion or noise: this one should, too.
void CheckAlive(const Channel& channel, bool moves, const BenchFormat& bench, const Expected& claim,
                std::vector<Finding>& findings) {
  if (channel.size() < kFewestToJudge || !moves) return;
  if (Moves(channel)) return CheckStuck(channel, bench, claim, findings);
  findings.push_back({true, fmt::format("{} in all {} readings: the channel is dead, or its column is another's",
                                        Text(*channel.column, channel.value[0]), channel.size())});
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
  constexpr double kEven = 1e-3;  // but for its errors and the last digit
  std::vector<double> way;
  for (std::size_t i = 1; i < channel.size(); ++i) way.push_back(std::abs(channel.value[i] - channel.value[i - 1]));
  const double usual = MiddleOf(way);
  const auto even = std::ranges::count_if(way, [usual](double w) { return std::abs(w - usual) < kEven * usual; });
  return 10 * even > 9 * std::ssize(way);
}

/// Another channel goes the same way from reading to reading, to a small part of the step and hardly ever none: the step is
/// the distance of the places that were read, some of them left out.
bool GoesAsFarAs(const Channel& other, const Channel& channel, double step) {
  constexpr double kOfStep = 0.1;  // of the way; rounding to steps leaves 0.4
  std::vector<double> way, others;
  std::size_t at = 0;
  const Reading* before = nullptr;
  double value = 0.0, others_value = 0.0;
  for (std::size_t i = 0; i < channel.size(); ++i) {
    while (at < other.size() && other.reading[at]->reading < channel.reading[i]->reading) ++at;
    if (at == other.size() || other.reading[at] != channel.reading[i]) continue;
    if (before != nullptr && before->pass == channel.reading[i]->pass && before->setup == channel.reading[i]->setup) {
      way.push_back(channel.value[i] - value);
      others.push_back(other.value[at] - others_value);
    }
    before = channel.reading[i], value = channel.value[i], others_value = other.value[at];
  }
  const auto stands = std::ranges::count(way, 0.0);
  if (way.size() < kFewestToJudge || 10 * stands > std::ssize(way)) return false;
  const auto as_vector = [](const std::vector<double>& x) { return Eigen::Map<const Eigen::VectorXd>(x.data(), std::ssize(x)); };
  const double ratio = as_vector(way).dot(as_vector(others)) / as_vector(others).squaredNorm();
  const auto near = (as_vector(way) - ratio * as_vector(others)).cwiseAbs().array() < kOfStep * step;
  return 10 * near.count() > 9 * std::ssize(way);
}

/// Steps that are larger than what scatters: the scatter is theirs.
void CheckSteps(const Channel& channel, const std::vector<Channel>& channels, const std::vector<double>& beside,
                std::vector<Finding>& findings) {
  if (channel.value.size() < kFewestToJudge || channel.column->role != ColumnRole::kShown) return;
  const double step = StepOf(channel);
  if (!(step > 2.0 * RobustNoiseOnCourse(beside)) || AreChosenStops(channel)) return;
  const auto is_its_way = [&](const Channel& other) { return other.column != channel.column && GoesAsFarAs(other, channel, step); };
  if (std::ranges::any_of(channels, is_its_way)) return;
  Reading reading;
  channel.column->number(reading) = step;
  const double shown = ParseNumber(channel.column->print(reading)).value_or(kNaN);
  findings.push_back({false, fmt::format("{} comes in steps of {:.6g}: that resolution is the largest part of its noise",
                                         channel.column->name, shown)});
}

}  // namespace

std::vector<Finding> Check(const std::vector<Reading>& readings, const Scenario& scenario,
                           const std::vector<Expected>& expected, const Plan& plan) {
  std::vector<Finding> findings;
  const BenchFormat& bench = FormatOf(scenario.bench);
  const std::vector<Channel> channels = ShownChannels(readings, bench);
  const auto says_why = [](const Reading& r) { return r.status != ReadingStatus::kOk && r.status != ReadingStatus::kMissing; };
  if (channels.empty() && std::ranges::any_of(readings, says_why)) return findings;  // "no_light": it is a finding already
  if (readings.size() < kFewest || channels.empty()) {
    findings.push_back({true, fmt::format("there are {} readings, none of which says anything", readings.size())});
    if (!channels.empty()) findings[0].line = fmt::format("there are only {} readings", readings.size());
    return findings;
  }
  const bool others_move = channels.size() == 1 || std::ranges::count_if(channels, Moves) * 2 >= std::ssize(channels);
  for (const ReadingColumn& column : bench.columns) {
    if (bench.range_of && column.number) CheckRange(ChannelOf(readings, column), bench.range_of(scenario, column.name), findings);
  }
  for (const Channel& channel : channels) {
    const auto found = std::ranges::find(expected, channel.column->name, &Expected::column);
    Expected claim = found == expected.end() || scenario.noise_free ? Expected{} : *found;
    claim.may_lag = bench.compared && channel.column->name == bench.compared->shown;
    CheckAlive(channel, !scenario.noise_free && (others_move || claim.noise > 0.0), bench, claim, findings);
    CheckSteps(channel, channels, Beside(channel, readings, bench), findings);
    if (!claim.column.empty() && Moves(channel)) CheckAgainst(claim, channel, findings);
    if (claim.course) CheckCourse(claim, channels, findings);
  }
  CheckLabels(readings, bench, findings);
  CheckPlan(readings, plan, findings);
  std::ranges::stable_sort(findings, {}, [](const Finding& f) { return !f.fatal; });
  return findings;
}

std::string InLines(const std::vector<Finding>& findings) {
  std::string text;
  for (const Finding& finding : findings) text += (finding.fatal ? "cannot be: " : "doubtful: ") + finding.line + "\n";
  return text;
}

void RefuseFatal(const std::vector<Finding>& findings, const std::string& where) {
  if (findings.empty() || !findings.front().fatal) return;
  throw InputError(where, findings.front().line, "readings that can be trusted");
}

}  // namespace twinbench::plausible
