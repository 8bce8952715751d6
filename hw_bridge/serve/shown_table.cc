#include "hw_bridge/serve/shown_table.h"

#include "twin/core/units.h"

namespace twinbench::hw {
namespace {

constexpr double kSlip_rad = -0.01 * units::deg;

}  // namespace

ShownTable::Refusal ShownTable::Refuses(double angle_rad) {
  if (angle_rad < lower_rad || angle_rad > upper_rad) return Refusal::kSoftLimit;
  if (mishap_.limit == 0) return Refusal::kNone;
  const bool onto_it = (angle_rad - State().encoder_rad) * mishap_.limit > 0.0;
  return onto_it ? Refusal::kLimitSwitch : Refusal::kNone;
}

void ShownTable::StartMove(double angle_rad) {
  mishap_.stands_still = mishap_.misses_window = false;
  mishap_.asked_rad.reset();
  Begin(angle_rad, faults_.TakeMove(name_));
}

void ShownTable::Begin(double angle_rad, Injected fault) {
  if (fault == Injected::kStandStill) {
    mishap_.stands_still = true;
    mishap_.asked_rad = angle_rad;
    return;
  }
  mishap_.limit = 0;
  double to_rad = angle_rad;
  if (fault == Injected::kLimit) {  // half-way there is a switch
    const double from_rad = State().encoder_rad;
    to_rad = 0.5 * (from_rad + angle_rad);
    mishap_.limit = angle_rad < from_rad ? -1 : 1;
  }
  if (fault == Injected::kLostStep) mishap_.slip_rad += kSlip_rad;
  mishap_.misses_window = fault == Injected::kNotInPosition || fault == Injected::kLimit;
  const double shift_rad = mishap_.origin_rad + mishap_.slip_rad;
  if (shift_rad != 0.0 || to_rad != angle_rad) mishap_.asked_rad = angle_rad;
  table_.StartMove(shift_rad != 0.0 ? to_rad + shift_rad : to_rad);
}

bool ShownTable::Settles(Duration within) {
  if (!CannotSettle()) return table_.Settles(within);
  clock_.Wait(within);
  return false;
}

TableState ShownTable::State() {
  TableState state = table_.State();
  const double shift_rad = mishap_.origin_rad + mishap_.slip_rad;
  if (shift_rad != 0.0) state.commanded_rad -= shift_rad;
  if (mishap_.asked_rad) state.commanded_rad = *mishap_.asked_rad;
  if (mishap_.origin_rad != 0.0) state.encoder_rad -= mishap_.origin_rad;
  if (mishap_.stands_still) state.moving = true;
  if (CannotSettle()) state.in_position = false;
  if (!mishap_.referenced) state.referenced = false;
  if (mishap_.limit != 0 && !state.moving) {
    state.limit = mishap_.limit;
    state.fault = "limit switch";
  }
  return state;
}

void ShownTable::Stop() {
  mishap_.stands_still = false;
  mishap_.asked_rad.reset();
  table_.Stop();
}

void ShownTable::Home() {
  mishap_ = {};
  table_.Home();
}

void ShownTable::LoseOrigin() {
  table_.Stop();
  mishap_ = {};
  mishap_.origin_rad = table_.State().encoder_rad;
  mishap_.asked_rad = 0.0;
  mishap_.referenced = false;
}

}  // namespace twinbench::hw
