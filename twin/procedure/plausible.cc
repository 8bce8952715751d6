#include "twin/procedure/plausible.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/core/bench_format.h"
#include "twin/core/device_fault.h"
#include "twin/core/number_text.h"
#include "twin/core/units.h"

namespace twinbench::procedure {
namespace {

constexpr Duration kClockTolerance = std::chrono::milliseconds(100);  // of two clocks that were just compared

bool NeighboursOfOnePass(const Reading& a, const Reading& b) {
  return a.phase == b.phase && a.setup == b.setup && a.pass == b.pass && a.phase == Phase::kFullCircle;
}

/// Where the encoder of the axis said that it stood at the begin of a reading; nothing: it was not looked at.
std::optional<double> EncoderOf(const Reading& reading) {
  for (const auto& [name, text] : reading.extra)
    if (name.ends_with("_encoder_before_deg")) return ParseInUnit(text, units::deg);
  return std::nullopt;
}

/// Whose lines say when a sample is taken.
const ReadingColumn& CountedColumn(const std::string& bench) {
  return *std::ranges::find(FormatOf(bench).columns, ColumnRole::kShown, &ReadingColumn::role);
}

}  // namespace

void RequirePlausible(const Reading& reading, const Reading& before, const Options& options) {
  const double room_degC = reading.temperature_degC;
  if (room_degC < options.coldest_degC || room_degC > options.hottest_degC) {
    throw DeviceFault(FaultKind::kImplausible, "thermometer",
                      fmt::format("{:.4g} degC; no bench is measured in such a room", room_degC));
  }
  if (!NeighboursOfOnePass(reading, before)) return;
  for (std::size_t c = 0; c < kChannels; ++c) {
    const double jump_V = std::abs(reading.mean_V[c] - before.mean_V[c]);
    if (!(jump_V > options.jump_V)) continue;
    throw DeviceFault(FaultKind::kImplausible, kChannelNames[c],
                      fmt::format("jumped by {:.4g} V from one measuring position to the next, {:.4g} V are allowed; did a table "
                                  "or the grating slip?",
                                  jump_V, options.jump_V));
  }
}

void RequireShown(const Reading& reading, const std::string& bench) {
  if (reading.status != ReadingStatus::kOk) return;
  for (const ReadingColumn& column : FormatOf(bench).columns) {
    if (column.role != ColumnRole::kShown || !column.print(reading).empty()) continue;
    throw DeviceFault(FaultKind::kGap, "instruments",
                      fmt::format("show no {} at reading {}: is it in view, and does everything stand where it was sent?", column.name,
                                  reading.reading));
  }
}

void RequireAnother(const Reading& sample, const Reading& before, const std::string& bench) {
  const ReadingColumn& counted = CountedColumn(bench);
  if (counted.print(sample) != counted.print(before)) return;
  throw DeviceFault(FaultKind::kProtocol, "instruments", "say one sample twice: lines of an encoder that turns are others");
}

void RequireNextLine(Reading sample, Reading before, const std::string& bench, int lines, double& step_rad) {
  const ReadingColumn& counted = CountedColumn(bench);
  const double way_rad = std::remainder(counted.number(sample) - counted.number(before), units::turn);
  if (std::isnan(step_rad)) step_rad = way_rad;
  if (std::abs(std::remainder(way_rad - step_rad, units::turn)) <= 0.5 * std::abs(step_rad) / lines) return;
  throw DeviceFault(
      FaultKind::kGap, "instruments",
      fmt::format(
          "{} went {:.6f} deg from one sample to the next and {:.6f} deg between the first two: were lines lost?",
          counted.name, way_rad / units::deg, step_rad / units::deg));
}

void RequireTogether(const Reading& reading, const Reading& before, const std::string& bench) {
  constexpr double kLeastWay_rad = 0.01 * units::deg;  // less may be noise of the reference
  const auto now = EncoderOf(reading), then = EncoderOf(before);
  if (!FormatOf(bench).compared || reading.setup != before.setup || !now || !then) return;
  const double way_rad = *now - *then;
  const double off_rad = std::remainder(reading.reference_rad - before.reference_rad - way_rad, units::turn);
  if (!(std::abs(off_rad) > 0.5 * std::max(std::abs(way_rad), kLeastWay_rad))) return;
  throw DeviceFault(FaultKind::kMoved, "reference",
                    fmt::format("went {:.6f} deg to this reading, and the encoder of its axis {:.6f} deg: does either stand?",
                                (way_rad + off_rad) / units::deg, way_rad / units::deg));
}

void RequireTimely(const Reading& sample, Time from, Time to) {
  if (sample.time >= from - kClockTolerance && sample.time <= to + kClockTolerance) return;
  throw DeviceFault(FaultKind::kClock, "instruments",
                    fmt::format("a sample is stamped {:.6f} s and was taken between {:.6f} and {:.6f} s of the bench's clock; a "
                                "field with an instrument's own time is \"ignored\"",
                                ToSeconds(sample.time), ToSeconds(from), ToSeconds(to)));
}

void RequireTimely(const Acquisition& block, Time asked, Time answered) {
  if (block.start >= asked - kClockTolerance && block.start <= answered + kClockTolerance) return;
  throw DeviceFault(
      FaultKind::kClock, "adc",
      fmt::format("a block is stamped {:.6f} s but was asked for at {:.6f} s; the clocks of converter "
                  "and bench part",
                  ToSeconds(block.start), ToSeconds(asked)));
}

}  // namespace twinbench::procedure
