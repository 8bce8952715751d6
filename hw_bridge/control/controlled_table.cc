#include "hw_bridge/control/controlled_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/core/number_text.h"
#include "twin/core/units.h"

namespace twinbench::hw {
namespace {

constexpr Duration kLook = std::chrono::seconds(1);  // between two looks at a table that finds its origin
/// A stop is heard as often while a table moves; as long as a held poll of ESP.
constexpr Duration kHears = std::chrono::milliseconds(50);

}  // namespace

ControlledTable::ControlledTable(DeviceLine line, const TableLimits& limits, CommandNumbers numbers)
    : line_(std::move(line)), limits_(limits), numbers_(numbers) {}

void ControlledTable::StartMove(double angle_rad) {
  RequireWithinLimits(angle_rad);
  RequireOrigin(State());
  if (agreed_) RequireAsAgreed(line_, {"of the table", true}, *agreed_, ReadAllowed());
  SendMove(numbers_.Text(angle_rad, units::deg));
  RequireUnderstood(angle_rad, State());
}

void ControlledTable::RequireWithinLimits(double angle_rad) const {
  if (angle_rad >= limits_.lower_rad && angle_rad <= limits_.upper_rad) return;
  line_.Fail(FaultKind::kLimit,
             fmt::format("a move to {:.6f} deg was not sent: its limits are {:.6f} and {:.6f} deg",
                         angle_rad / units::deg, limits_.lower_rad / units::deg, limits_.upper_rad / units::deg));
}

void ControlledTable::RequireOrigin(const TableState& now) const {
  if (!now.referenced)
    line_.Fail(FaultKind::kRestarted, "the controller has lost its origin; its angles mean nothing");
}

void ControlledTable::RequireUnderstood(double angle_rad, const TableState& now) {
  if (!now.referenced) StopAndFail(FaultKind::kRestarted, "the controller lost its origin as the move began");
  const double off_rad = std::abs(now.commanded_rad - angle_rad);
  if (off_rad <= numbers_.Understood(units::deg)) return;
  StopAndFail(
      FaultKind::kRefused,
      fmt::format("was commanded to {} deg and understood {} deg, {:.4g} arcsec off", numbers_.Text(angle_rad, units::deg),
                  PrintInUnit(now.commanded_rad, units::deg), off_rad / units::arcsec));
}

bool ControlledTable::Settles(Duration within) {
  if (!AwaitSettledOrStop(within)) return false;
  RequireOrigin(State());
  return true;
}

bool ControlledTable::AwaitSettledOrStop(Duration within) {
  if (!line_.HearsStop()) return AwaitSettled(within);
  do {
    line_.RequireGoingOn();
    const Duration piece = std::min(within, kHears);
    if (AwaitSettled(piece)) return true;
    within -= piece;
  } while (within > Duration(0));
  return false;
}

TableState ControlledTable::State() {
  TableState state = ReadState();
  if (!state.referenced) state.commanded_rad = state.encoder_rad = kNaN;
  return state;
}

void ControlledTable::Stop() {
  line_.SayFirst(StopWord());
  SendStop();
}

void ControlledTable::Home() {
  SendHome();
  const auto end = FromSeconds(limits_.move_timeout_s);
  Duration passed{};
  while (!AwaitSettled(kLook)) {
    passed += kLook;
    if (passed >= end)
      StopAndFail(FaultKind::kNotInPosition, fmt::format("no origin found in {:.0f} s", ToSeconds(passed)));
  }
  if (!State().referenced)
    line_.Fail(FaultKind::kRestarted, "the controller has no origin after it looked for one");
}

void ControlledTable::AgreeOnLimits() {
  agreed_ = ReadAllowed();
  const double lower_rad = agreed_->lower, upper_rad = agreed_->upper;
  if (std::isinf(limits_.lower_rad)) limits_.lower_rad = lower_rad;
  if (std::isinf(limits_.upper_rad)) limits_.upper_rad = upper_rad;
  const double slack_rad = numbers_.Understood(units::deg);
  if (limits_.lower_rad >= lower_rad - slack_rad && limits_.upper_rad <= upper_rad + slack_rad) return;
  line_.Fail(FaultKind::kRefused,
             fmt::format("the controller allows {:.6f} to {:.6f} deg; the bench file {:.6f} to {:.6f} deg",
                         lower_rad / units::deg, upper_rad / units::deg, limits_.lower_rad / units::deg,
                         limits_.upper_rad / units::deg));
}

}  // namespace twinbench::hw
