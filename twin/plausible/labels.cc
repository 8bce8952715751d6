#include "twin/plausible/checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "twin/core/number_text.h"
#include "twin/core/units.h"
#include "twin/plausible/channel.h"

namespace twinbench::plausible {
namespace {

constexpr double kContradicted = 0.3;                        // of the labels of a run
constexpr double kFastest_rad_s = 1e6 * units::turn / 60.0;  // a million turns a minute: no spindle does
constexpr double kTurnsAPass = 20.0;                         // or less than a turn by so much: no circle is measured so

/// The angle that a bench's positions and directions are labels of; null if it has no such.
const ReadingColumn* LabelledAngle(const BenchFormat& bench) {
  for (const ReadingColumn& column : bench.columns) {
    if (column.role == ColumnRole::kRequired && column.number) return column.name.ends_with("_deg") ? &column : nullptr;
  }
  return nullptr;
}

/// Two readings of one pass that have the same position and stand at different angles.
void CheckPositions(const std::vector<Reading>& readings, const ReadingColumn& angle, std::vector<Finding>& findings) {
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
      {true, fmt::format("{} of {} readings have the position of another one of their pass, at another {}; reading {} "
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
void CheckDirections(const std::vector<Reading>& readings, const ReadingColumn& angle, std::vector<Finding>& findings) {
  std::size_t judged = 0, wrong = 0;
  for (std::size_t i = 1; i < readings.size(); ++i) {
    const Reading& here = readings[i];
    const Reading& before = readings[i - 1];
    if (here.phase != Phase::kFullCircle || here.setup != before.setup || here.pass != before.pass || here.direction == 0) continue;
    const double step = ValueOf(angle, here) - ValueOf(angle, before);
    if (!(std::abs(step) > 1e-9) || std::abs(step) > units::turn / 2.0) continue;
    ++judged;
    if (step * here.direction < 0.0) ++wrong;
  }
  if (judged < kFewestToJudge || static_cast<double>(wrong) < kContradicted * static_cast<double>(judged)) return;
  findings.push_back(
      {false, fmt::format("{} of {} steps of {} go against the direction that the readings say", wrong, judged, angle.name)});
}

void CheckClock(const std::vector<Reading>& readings, std::vector<Finding>& findings) {
  if (readings.size() < kFewestToJudge || readings.front().time < readings.back().time) return;
  findings.push_back({false, "all readings have the same time: nothing can be said about drifts and delays"});
}

/// A pass of a full circle that is a small part of a turn, or many turns.
void CheckCircle(const std::vector<Reading>& readings, const ReadingColumn& angle, std::vector<Finding>& findings) {
  std::map<std::pair<int, int>, std::vector<double>> passes;
  for (const Reading& reading : readings) {
    if (reading.phase == Phase::kFullCircle) passes[{reading.setup, reading.pass}].push_back(ValueOf(angle, reading));
  }
  std::vector<double> turns;
  for (const auto& [pass, at] : passes) {
    const auto [low, high] = std::ranges::minmax(at);
    if (at.size() >= kFewestToJudge) turns.push_back((high - low) / units::turn);
  }
  const double usual = MiddleOf(turns);
  if (turns.empty() || (usual > 1.0 / kTurnsAPass && usual < kTurnsAPass)) return;
  findings.push_back(
      {usual > 1.0, fmt::format("{} makes {:.3g} turns in a pass of the full circle: is it in deg?", angle.name, usual)});
}

/// All that a row says but its number.
std::vector<double> RowOf(const Reading& r, const BenchFormat& bench) {
  std::vector<double> row = {ToSeconds(r.time), 1.0 * r.setup,    1.0 * r.pass,
                             1.0 * r.direction, 1.0 * r.position, static_cast<double>(r.phase)};
  for (const ReadingColumn& column : bench.columns) {
    if (!column.number) continue;
    const double value = ValueOf(column, r);
    row.push_back(std::isfinite(value) ? value : -INFINITY);
  }
  return row;
}

/// Values so coarse that two of them are equal by chance.
bool IsCoarse(const Channel& channel) {
  const auto [low, high] = std::ranges::minmax(channel.value);
  return !(high - low > 4.0 * StepOf(channel) * static_cast<double>(channel.size()));
}

void CheckRepeatedRows(const std::vector<Reading>& readings, const BenchFormat& bench, std::vector<Finding>& findings) {
  std::set<std::vector<double>> rows;
  std::size_t again = 0;
  int example = 0;
  for (const Reading& reading : readings) {
    if (reading.status != ReadingStatus::kOk || rows.insert(RowOf(reading, bench)).second) continue;
    ++again;
    example = reading.reading;
  }
  if (again < kFewestToJudge || std::ranges::all_of(ShownChannels(readings, bench), IsCoarse)) return;
  findings.push_back(
      {true, fmt::format("{} of {} rows repeat another one, its time and values to the last digit, reading {} among them: they "
                         "are no readings of their own",
                         again, readings.size(), example)});
}

/// The column of the place that an axis was filed at.
const ReadingColumn* FiledPlace(const BenchFormat& bench, const std::string& axis, const std::string& unit) {
  const std::string reference = bench.compared ? bench.compared->reference : "";
  for (const std::string& name : {axis + unit, "commanded_" + axis + unit, axis + "_encoder" + unit, reference}) {
    const auto column = std::ranges::find(bench.columns, name, &ReadingColumn::name);
    if (column != bench.columns.end()) return &*column;
  }
  return nullptr;
}

/// Whether an axis went from one reading to the next: it was filed at another place, or stood further from where it was than an axis does that
/// comes to one place again.
bool Went(double filed_step, double step, double to_SI) {
  const double rests_within = 0.1 * to_SI;
  return step > 0.0 && (step > rests_within || std::abs(filed_step) > 0.5 * step);
}

/// How far an axis stood from the place that its readings are filed at, but for a constant of each set-up [SI].
struct Elsewhere {
  std::vector<const Reading*> reading;
  std::vector<double> off, step;
};

Elsewhere ElsewhereOf(const std::vector<Reading>& readings, const ReadingColumn& place, const std::string& encoder, double to_SI) {
  Elsewhere found;
  std::map<int, double> first;
  std::map<int, std::pair<double, double>> before;  // filed at, stood at
  for (const Reading& reading : readings) {
    const auto text = reading.extra.find(encoder);
    const auto stood = text == reading.extra.end() ? std::nullopt : ParseInUnit(text->second, to_SI);
    if (!stood) continue;
    const double at = ValueOf(place, reading);
    const double off = first.try_emplace(reading.setup, *stood - at).first->second - (*stood - at);
    found.reading.push_back(&reading);
    found.off.push_back(std::abs(to_SI == units::deg ? std::remainder(off, units::turn) : off));
    if (const auto last = before.find(reading.setup); last != before.end()) {
      const double step = std::abs(*stood - last->second.second);
      if (Went(at - last->second.first, step, to_SI)) found.step.push_back(step);
    }
    before[reading.setup] = {at, *stood};
  }
  return found;
}

/// An axis whose own encoder stood nearer to another place than to the one that a reading is filed at.
void CheckAxes(const std::vector<Reading>& readings, const BenchFormat& bench, std::vector<Finding>& findings) {
  constexpr std::string_view kBefore = "_encoder_before";
  std::set<std::string> encoders;
  for (const Reading& reading : readings) {
    for (const auto& [name, text] : reading.extra)
      if (name.find(kBefore) != name.npos) encoders.insert(name);
  }
  for (const std::string& name : encoders) {
    const std::string axis = name.substr(0, name.find(kBefore)), unit = name.substr(name.rfind('_'));
    const ReadingColumn* place = FiledPlace(bench, axis, unit);
    if (!place || (unit != "_deg" && unit != "_mm")) continue;
    const Elsewhere found = ElsewhereOf(readings, *place, name, unit == "_deg" ? units::deg : units::mm);
    const double nearer = 0.5 * MiddleOf(found.step);
    const auto is_elsewhere = [nearer](double off) { return off > nearer; };
    const auto elsewhere = std::ranges::count_if(found.off, is_elsewhere);
    if (elsewhere == 0 || !(nearer > 0.0)) continue;
    const auto example = std::ranges::find_if(found.off, is_elsewhere) - found.off.begin();
    findings.push_back(
        {true,
         fmt::format("{} of {} readings have {} at another place than {} says, reading {} is the first of them: "
                     "the axis and what was read do not go together",
                     elsewhere, found.off.size(), name, place->name, found.reading[static_cast<std::size_t>(example)]->reading)});
  }
}

}  // namespace

void CheckLabels(const std::vector<Reading>& readings, const BenchFormat& bench, std::vector<Finding>& findings) {
  if (const ReadingColumn* angle = LabelledAngle(bench)) {
    CheckPositions(readings, *angle, findings);
    CheckDirections(readings, *angle, findings);
    if (bench.tables) CheckCircle(readings, *angle, findings);
  }
  for (const ReadingColumn& column : bench.columns) {
    if (column.role == ColumnRole::kRequired && column.number && column.name.ends_with("_deg"))
      CheckSpeed(readings, column, findings);
  }
  CheckClock(readings, findings);
  CheckRepeatedRows(readings, bench, findings);
  CheckAxes(readings, bench, findings);
}

}  // namespace twinbench::plausible
