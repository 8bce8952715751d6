#include "twin/import/make_readings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/core/errors.h"
#include "twin/core/reading_clock.h"
#include "twin/core/units.h"
#include "twin/import/column_words.h"
#include "twin/import/common.h"
#include "twin/import/held_command.h"
#include "twin/import/pushed.h"
#include "twin/import/said.h"
#include "twin/import/whole_rows.h"

namespace twinbench::imports {
namespace {

double MeanOf(const std::vector<double>& values, const Block& block) {
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t i = block.begin; i < block.end; ++i) {
    if (!std::isfinite(values[i])) continue;
    sum += values[i];
    ++count;
  }
  return count > 0 ? sum / static_cast<double>(count) : std::nan("");
}

/// Every jump of more than three quarters of a turn begins a pass that a list without a clock numbers: it is the same places again.
bool JumpsBetweenPasses(const Session& session, const std::vector<double>& reference) {
  const auto pass = session.value.find("pass");
  if (session.has_clock || pass == session.value.end()) return false;
  for (std::size_t i = 1; i < reference.size(); ++i) {
    if (std::abs(reference[i] - reference[i - 1]) > 0.75 * units::turn && pass->second[i] == pass->second[i - 1]) return false;
  }
  return true;
}

/// Every change of the side begins a pass.
void NumberApproaches(const std::vector<double>& direction, Course& course) {
  for (std::size_t i = 1; i < direction.size(); ++i) {
    const bool turned = direction[i] != direction[i - 1];
    course.reversals += turned ? 1 : 0;
    course.pass[i] = course.pass[i - 1] + (turned ? 1 : 0);
  }
}

}  // namespace

void Maker::Take(const Session& session, const MostReadings& most, Imported& imported) {
  if (session.Rows() < 2) return;
  const std::string& by = CourseColumn(session);
  const std::vector<double>& reference = session.value.at(by);
  const bool is_driven_back = map_.course.wrap_rad == 0.0 && JumpsBetweenPasses(session, reference);
  const double wrap = is_driven_back ? 0.0 : FindWrap(reference, map_.course, linear_);
  const std::vector<double> no_clock;
  const bool one_place = bench_.compared && IsOnePlace(session);
  const bool is_in_time = session.has_clock && !one_place && !IsSentAnewEveryRow(session);
  Course course = CourseOf(reference, is_in_time ? session.time_s : no_clock, map_.course, wrap);
  if (one_place && session.value.contains("direction")) NumberApproaches(session.value.at("direction"), course);
  if (bench_.compared && !one_place) {
    const Alignment alignment = AlignmentOf(session, course.reference, bench_, map_);
    if (alignment.IsNeeded()) return Take(Aligned(session, alignment), most, imported);
  }
  if (const std::vector<std::size_t> fresh = Fresh(session, course); !fresh.empty()) {
    tally.left_out.push_back({session.Rows() - fresh.size(), "rows in which a value of the reference was held that is not new, while the device went on"});
    return Take(Chosen(session, fresh), most, imported);
  }
  if (bench_.compared) {
    const HowItFollows follows = RequireOneToOne(session, course.reference, one_place, bench_, map_);
    if (follows.is_later && !session.has_clock && map_.course.kind == "auto") return TakeAtUsualRate(session, follows.said, most, imported);
    if (!follows.said.empty() && !is_at_usual_rate_) tally.remarks.push_back(follows.said);
  }
  const bool may_be_pushed =
      (course.stop_and_go || (one_place && session.has_clock)) && !session.value.contains("direction");
  if (bench_.compared && may_be_pushed && TakePushed(session, course, imported)) return EndSetUp();
  if (bench_.compared && IsProfile(session, course)) {
    course.stop_and_go = false;
    tally.remarks.push_back("the command moves along profiles and the device is read all the way: taken as motion with rests; "
                            "[course] kind = \"stops\" in a map takes the rests alone");
  }
  const Blocks cut = CutIntoBlocks(course, session.time_s, most, RestsIn(session, course));
  Count(session, course, cut);
  if (course.stop_and_go) {
    TakeStops(session, course, cut, imported);
  } else {
    const bool may_come = one_place && session.has_clock && !linear_;
    const std::size_t on_way = may_come ? RowsOnTheWay(session.value.at(bench_.compared->shown), reference.front(), units::turn) : 0;
    if (on_way > 0) tally.left_out.push_back({on_way, "rows at the beginning, on the way to the only place"});
    for (const Block& block : cut.blocks) {
      if (block.begin >= on_way) Append(session, course, block, {block.begin, MeanOf(course.reference, block)}, imported);
    }
  }
  EndSetUp();
}

/// At rest nothing comes later: rows without a clock are motion then, which is seldom read by hand.
void Maker::TakeAtUsualRate(Session session, const std::string& how_it_follows, const MostReadings& most, Imported& imported) {
  constexpr double kUsualRate_Hz = 100.0;
  tally.remarks.push_back(fmt::format("{0}: taken as motion that was read {1:g} times a second; --column 'rate_Hz={1:g}' says how often", how_it_follows, kUsualRate_Hz));
  session.has_clock = is_at_usual_rate_ = true;
  for (double& t_s : session.time_s) t_s /= kUsualRate_Hz;  // which were rows
  Take(session, most, imported);
  is_at_usual_rate_ = false;
}

void Maker::EndSetUp() {
  ++setup_;
  first_pass_ = last_pass_ + 1;
}

/// Nothing else says as much as rests in which the device is pushed to and fro: every row of them is a reading.
/// @return false if it is pushed nowhere.
bool Maker::TakePushed(const Session& session, Course course, Imported& imported) {
  const std::vector<double>& shown = session.value.at(bench_.compared->shown);
  const std::vector<Rest> rests =
      course.stop_and_go ? RestsOf(course, {}, 0.0) : std::vector<Rest>{{0, session.Rows(), 0, true}};
  const Pushed pushed = PushedIn(course, rests, shown, linear_ ? 0.0 : units::turn);
  if (pushed.rows.empty()) return false;
  course.stops = true, course.stop_and_go = false;
  course.reversals = pushed.pass.back();
  Blocks cut;
  for (std::size_t k = 0; k < pushed.rows.size(); ++k) {
    const std::size_t row = pushed.rows[k];
    course.direction[row] = pushed.direction[k];
    course.pass[row] = pushed.pass[k];
    course.motion[row] = Motion::kStop;
    cut.blocks.push_back({row, row + 1, 0});
  }
  Count(session, course, cut);
  if (const std::size_t others = session.Rows() - pushed.rows.size(); others > 0)
    tally.left_out.push_back(
        {others,
         "rows on the way to places where the device is pushed to and fro, between its sides there, or elsewhere"});
  tally.remarks.push_back(
      "the command rests while the device is pushed to and fro: the direction of a row is the side on which the "
      "device stands");
  for (const Block& block : cut.blocks)
    Append(session, course, block, {block.begin, course.reference[block.begin]}, imported);
  return true;
}

/// Said once, however many set-ups there are.
Session Maker::Aligned(Session session, const Alignment& alignment) {
  for (double& x : session.value.at(bench_.compared->reference)) x *= alignment.reference;
  for (double& x : session.value.at(bench_.compared->shown)) x *= alignment.shown;
  if (std::ranges::count(tally.assumed, alignment.said) == 0) tally.assumed.push_back(alignment.said);
  return session;
}

/// Of a reference whose values are held while the device goes on (held_command.h).
std::vector<std::size_t> Maker::Fresh(const Session& session, const Course& course) const {
  if (!bench_.compared || !course.stop_and_go || map_.course.kind != "auto") return {};
  return FreshRows(course, session.value.at(bench_.compared->shown), linear_ ? 0.0 : units::turn);
}

/// A controller's log: the ways of a command, from rest to rest, are read as closely as its rests.
bool Maker::IsProfile(const Session& session, const Course& course) const {
  constexpr double kFewestRows = 20.0, kLongest_s = 0.02, kLeastShare = 0.1;  // of a way; between rows; of all rows
  if (!course.stop_and_go || map_.course.kind != "auto" || !IsCalledCommand(ExpressionOf(map_, bench_.compared->reference))) return false;
  const double moving = (1.0 - course.rest_share) * static_cast<double>(session.Rows());
  return MedianOf(StepsOf(session.time_s)) <= kLongest_s && moving > kFewestRows * course.rests &&
         moving > kLeastShare * static_cast<double>(session.Rows());
}

/// A command that goes to and fro from each row to the next, rows that are far apart: each of them is a place.
bool Maker::IsSentAnewEveryRow(const Session& session) const {
  constexpr double kShortest_s = 0.1, kLeastShare = 0.5;
  if (!bench_.compared || map_.course.kind != "auto" || !IsCalledCommand(ExpressionOf(map_, bench_.compared->reference))) return false;
  std::vector<double> steps = StepsOf(session.value.at(bench_.compared->reference));
  const double rows = static_cast<double>(steps.size());
  std::erase(steps, 0.0);
  std::size_t turns = 0;
  for (std::size_t i = 1; i < steps.size(); ++i) turns += steps[i] * steps[i - 1] < 0.0 ? 1 : 0;
  return MedianOf(StepsOf(session.time_s)) > kShortest_s && static_cast<double>(turns) > kLeastShare * rows;
}

/// Of a drive from stop to stop; empty: of another.
std::vector<Rest> Maker::RestsIn(const Session& session, const Course& course) const {
  if (!course.stop_and_go) return {};
  const std::vector<double> none;
  const std::vector<Rest> rests =
      RestsOf(course, bench_.compared ? session.value.at(bench_.compared->shown) : none, linear_ ? 0.0 : units::turn);
  const auto fewest = static_cast<std::ptrdiff_t>(kFewestCompared);
  if (bench_.compared && std::ssize(rests) < fewest)
    throw InputError(NameOf(map_, bench_.compared->reference), "the command makes one step and rests before it and behind it: that is all",
                     "a recording with three rests at least, of more steps; or [course] kind = \"sweep\" in a map, to take it as motion");
  const auto arrived = std::ranges::count(rests, true, &Rest::arrives);
  if (bench_.compared && arrived < fewest)
    throw InputError(NameOf(map_, bench_.compared->shown),
                     fmt::format("the device arrives in {} of the {} rests of {} only", arrived, rests.size(), bench_.compared->reference),
                     "longer rests; or [course] kind = \"sweep\" in a map, to take it as motion");
  return rests;
}

/// By what the course is told: the reference of a bench that compares, else the first column there is.
std::string Maker::CourseColumn(const Session& session) const {
  if (bench_.compared) return bench_.compared->reference;
  for (const ReadingColumn& column : bench_.columns) {
    if (column.role == ColumnRole::kRequired && session.value.contains(column.name) && UnitAtEnd(column.name))
      return column.name;
  }
  return session.value.begin()->first;
}

/// The reference stands still, and every row says when it was read or from which side the axis came to it.
bool Maker::IsOnePlace(const Session& session) const {
  const auto [low, high] = std::ranges::minmax(session.value.at(bench_.compared->reference));
  const auto direction = session.value.find("direction");
  if (low != high || session.has_clock) return low == high;
  if (direction == session.value.end()) return false;
  const auto comes = [&direction](double from) { return std::ranges::find(direction->second, from) != direction->second.end(); };
  return comes(1.0) && comes(-1.0);
}

void Maker::Count(const Session& session, const Course& course, const Blocks& cut) {
  tally.rows += session.Rows();
  tally.wraps += course.wraps;
  tally.reversals += course.reversals;
  tally.rests += course.rests;
  tally.fly_backs += course.fly_backs;
  tally.low = std::min(tally.low, std::ranges::min(course.reference));
  tally.high = std::max(tally.high, std::ranges::max(course.reference));
  tally.fastest = std::max(tally.fastest, course.fastest);
  tally.rest_share = std::max(tally.rest_share, course.rest_share);
  tally.widest = std::max(tally.widest, cut.widest);
  tally.usual_rows = std::max(tally.usual_rows, cut.usual_rows);
  tally.stops = tally.stops && (course.stops || course.stop_and_go);
  if (cut.left_out > 0) tally.left_out.push_back({cut.left_out, "rows on the way between measuring positions"});
  std::size_t settling = 0;
  for (std::size_t k = 0; course.stop_and_go && k < cut.blocks.size(); ++k)
    settling += k > 0 && cut.blocks[k].rest == cut.blocks[k - 1].rest ? 0 : cut.blocks[k].begin - cut.blocks[k].rest;
  if (settling > 0) tally.left_out.push_back({settling, "rows at the beginning of rests, before the device stood"});
  if (cut.moving > 0)
    tally.left_out.push_back({cut.moving, fmt::format("rows of {} rests of the command at whose end the device was still on its way", cut.moving_rests)});
}

/// Every rest is a reading, or several pieces of which each has the sense in which the axis came to the rest.
void Maker::TakeStops(const Session& session, const Course& course, const Blocks& cut, Imported& imported) {
  std::vector<double> places;
  std::vector<std::size_t> rest_of;  // by block
  for (std::size_t k = 0; k < cut.blocks.size(); ++k) {
    const bool is_piece = k > 0 && cut.blocks[k].rest == cut.blocks[k - 1].rest;
    if (!is_piece) places.push_back(MeanOf(course.reference, cut.blocks[k]));
    rest_of.push_back(places.size() - 1);
  }
  CourseSettings stops;
  stops.kind = "stops";
  const Course from_stop_to_stop = CourseOf(places, {}, stops, 0.0);
  for (std::size_t k = 0; k < cut.blocks.size(); ++k) {
    Reading& reading = Append(session, from_stop_to_stop, cut.blocks[k], {rest_of[k], places[rest_of[k]]}, imported);
    if (ColumnOf(bench_, "dwell_s"))
      reading.dwell_s = session.time_s[cut.blocks[k].begin] - session.time_s[cut.blocks[k].rest];
  }
}

Reading& Maker::Append(const Session& session, const Course& course, const Block& block, const Place& place,
                         Imported& imported) {
  Reading reading;
  const std::size_t at = place.at;
  reading.reading = static_cast<int>(imported.readings.size());
  reading.time = Time(FromSeconds(MeanOf(session.time_s, block)));
  reading.setup = setup_;
  reading.phase = PhaseOf(map_.course.phase).value_or(reading.phase);
  reading.pass = first_pass_ + course.pass[at];
  reading.direction = course.direction[at];
  const auto stated = session.value.find("pass");  // a circle's passes are not those of one of its axes
  const double own = stated == session.value.end() ? kNaN : stated->second[block.begin];
  const int pass = std::isfinite(own) ? static_cast<int>(std::lround(own)) : reading.pass;
  if (pass != last_pass_) position_ = 0;
  last_pass_ = pass;
  reading.position = position_++;
  if (block.end - block.begin > 1) reading.n_samples = static_cast<int>(block.end - block.begin);
  for (const auto& [name, values] : session.value) Fill(name, values, block, reading);
  if (bench_.compared) ColumnOf(bench_, bench_.compared->reference)->number(reading) = place.reference;
  if (bench_.compared && !course.stops && std::isfinite(course.velocity[at]))
    ColumnOf(bench_, bench_.compared->velocity)->number(reading) = MeanOf(course.velocity, block);
  reading.extra["motion"] = MotionName(course.motion[at]);
  if (!session.has_clock) reading.extra[kClockColumn] = kNoClock;
  imported.readings.push_back(std::move(reading));
  return imported.readings.back();
}

/// Numbers are means, labels are the first row's.
void Maker::Fill(const std::string& name, const std::vector<double>& values, const Block& block,
          Reading& reading) const {
  const ReadingColumn* column = ColumnOf(bench_, name);
  if (column && column->number) {
    column->number(reading) = MeanAngle(name, values, block);
    return;
  }
  const double value = values[block.begin];
  if (!std::isfinite(value)) return;
  const std::string text = fmt::format("{}", std::lround(value));
  if (column && !column->parse(reading, text))
    throw InputError(NameOf(map_, name), fmt::format("{} is {}", name, text), column->expected);
}

/// Of a device that starts again at a turn: rows of a block are taken together by the nearest way.
double Maker::MeanAngle(const std::string& name, const std::vector<double>& values, const Block& block) const {
  if (!bench_.compared || name != bench_.compared->shown || linear_) return MeanOf(values, block);
  const double first = values[block.begin];
  double sum = 0.0;
  for (std::size_t i = block.begin; i < block.end; ++i) sum += std::remainder(values[i] - first, units::turn);
  return first + sum / static_cast<double>(block.end - block.begin);
}

}  // namespace twinbench::imports
