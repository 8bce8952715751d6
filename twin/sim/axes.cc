#include "twin/sim/axes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "twin/core/device_fault.h"
#include "twin/sim/block_course.h"

namespace twinbench::sim {
namespace {

constexpr Duration kSettleCheck = std::chrono::milliseconds(1);  // in which the servos are looked at

}  // namespace

mechanics::StackParameters StackOf(const TableStack& described) {
  mechanics::StackParameters stack;
  const MechanicsSettings& m = described.mechanics;
  const std::array<const TableSettings*, 2> tables = {&described.target, &described.reference};
  for (std::size_t k = 0; k < 2; ++k) {
    mechanics::TableParameters& table = stack.table[k];
    table.axial_stiffness_N_m = m.axial_stiffness_N_m[k];
    table.radial_stiffness_N_m = m.radial_stiffness_N_m[k];
    table.tilt_stiffness_Nm_rad = m.tilt_stiffness_Nm_rad[k];
    table.servo_Hz = m.servo_Hz[k];
    table.backlash_rad = tables[k]->backlash_rad;
    table.friction = {.coulomb_Nm = m.friction_Nm[k],
                      .static_ratio = m.friction_static_ratio[k],
                      .stribeck_rad_s = m.friction_stribeck_rad_s[k],
                      .presliding_rad = m.friction_presliding_rad[k],
                      .viscous_Nm_s = m.friction_viscous_Nm_s[k]};
    table.cable = {m.cable_stiffness_Nm_rad[k], m.cable_torque_Nm[k], m.cable_azimuth_rad[k]};
    table.unbalance = {m.unbalance_kg_m[k], m.unbalance_azimuth_rad[k]};
    table.scale = {.resolution_rad = m.encoder_resolution_rad[k],
                   .subdivision_rad = m.encoder_subdivision_rad[k],
                   .periods = m.encoder_periods};
  }
  stack.payload.mass_kg = m.payload_mass_kg;
  stack.payload.radius_m = m.payload_radius_m;
  stack.payload.azimuth_rad = m.payload_azimuth_rad;
  stack.payload.height_m = m.payload_height_m;
  stack.damping_ratio = m.damping_ratio;
  stack.step_s = m.step_s;
  stack.geometry = described.geometry;
  return stack;
}

Axes::Axes(const TableStack& stack, EventQueue& queue)
    : queue_(queue),
      schedules_{Schedule(queue, "target"), Schedule(queue, "reference")},
      servo_period_(FromSeconds(stack.mechanics.step_s)),
      is_driven_(stack.mechanics.fidelity != "kinematic"),
      plant_(mechanics::MakePlant(mechanics::FidelityFromName(stack.mechanics.fidelity), StackOf(stack))),
      restlessness_(stack.mechanics, StackOf(stack), stack.seed) {
  const std::array<const TableSettings*, 2> tables = {&stack.target, &stack.reference};
  for (std::size_t k = 0; k < 2; ++k) {
    drives_[k].move_time_s = tables[k]->move_time_s;
    drives_[k].speed_rad_s = tables[k]->speed_rad_s;
    drives_[k].settle_s = tables[k]->settle_s;
    drives_[k].arrival = Time{} - FromSeconds(tables[k]->settle_s);  // long there
  }
}

bool Axes::StartMove(mechanics::Axis axis, double to_rad) {
  Drive& d = drive(axis);
  const double travel_rad = to_rad - d.commanded_rad;
  if (travel_rad == 0.0) return false;
  if (Moving(axis)) throw DeviceFault(FaultKind::kRefused, "table", "a move was asked for while another one runs");
  const double duration_s = std::max(d.move_time_s, std::abs(travel_rad) / d.speed_rad_s);
  CatchUp();
  d.departed_rad = Encoder_rad(axis);
  plant_->StartMove(axis, to_rad, duration_s);
  plant_state_.reset();
  d.commanded_rad = to_rad;
  d.direction = travel_rad > 0.0 ? 1 : -1;
  d.arrival = queue_.Now() + FromSeconds(duration_s);
  d.departure = queue_.Now();
  last_arrival_ = std::max(last_arrival_, d.arrival);
  schedules_[static_cast<std::size_t>(axis)].At(d.arrival, [this] { CatchUp(); });
  if (is_driven_ && !serving_) Serve();
  return true;
}

bool Axes::Settles(mechanics::Axis axis, Duration within) {
  Drive& d = drive(axis);
  const Time window_end = d.arrival + FromSeconds(d.settle_s);
  const Time patience_end = queue_.Now() + within;
  if (queue_.Now() < window_end) queue_.RunUntil(std::min(window_end, patience_end));
  if (queue_.Now() < window_end) return false;
  CatchUp();
  const bool goes_on = d.given_up == queue_.Now();  // the same looks, however they are cut into calls
  if (!goes_on) {
    if (plant_->Settled(axis)) return true;
    d.watched_from = queue_.Now();
  }
  for (;;) {
    const auto looks = (queue_.Now() - d.watched_from) / kSettleCheck;
    const Time next = d.watched_from + (looks + 1) * kSettleCheck;
    if (next > patience_end) break;
    queue_.RunUntil(next);
    CatchUp();
    if (plant_->Settled(axis)) return true;
  }
  queue_.RunUntil(patience_end);
  d.given_up = patience_end;
  return false;
}

/// Steps of the servos from a move's begin until both are quiet; at rest nothing happens.
void Axes::Serve() {
  serving_ = true;
  schedules_[0].At(queue_.Now() + kSettleCheck, [this] {
    CatchUp();
    serving_ = false;
    if (IsRestless()) Serve();
  });
}

const mechanics::StackState& Axes::PlantState() {
  CatchUp();
  if (!plant_state_) plant_state_ = plant_->State();
  return *plant_state_;
}

double Axes::Encoder_rad(mechanics::Axis axis) {
  const mechanics::StackState& state = PlantState();
  return axis == mechanics::Axis::kTarget ? state.target_encoder_rad : state.reference_encoder_rad;
}

double Axes::Travelled_rad(mechanics::Axis axis) {
  return std::abs(Encoder_rad(axis) - drive(axis).departed_rad);
}

bool Axes::IsRestless() {
  CatchUp();
  return !plant_->Settled();
}

double Axes::Shortest_s() {
  const double servos_s = IsRestless() ? BlockCourse::kKnotsAPeriod * ToSeconds(servo_period_)
                                       : std::numeric_limits<double>::infinity();
  return std::min(servos_s, restlessness_.Shortest_s());
}

bool Axes::InPosition(mechanics::Axis axis) {
  CatchUp();
  return queue_.Now() >= drive(axis).arrival + FromSeconds(drive(axis).settle_s) && plant_->Settled(axis);
}

void Axes::Stop(mechanics::Axis axis) {
  if (!Moving(axis)) return;
  CatchUp();
  plant_->Stop(axis);
  plant_state_.reset();
  Drive& d = drive(axis);
  d.commanded_rad = plant_->CommandedEnd_rad(axis);
  d.arrival = queue_.Now() + FromSeconds(mechanics::Plant::kBraking_s);
  last_arrival_ = std::max(last_arrival_, d.arrival);
}

bool Axes::ComeToRest() {
  if (Moving(mechanics::Axis::kTarget) || Moving(mechanics::Axis::kReference)) return false;
  const Time patience_end = queue_.Now() + std::chrono::seconds(1);
  for (CatchUp(); !plant_->Settled() && queue_.Now() < patience_end; CatchUp()) {
    queue_.RunUntil(queue_.Now() + kSettleCheck);
  }
  return plant_->Settled();
}

void Axes::Mount(const mechanics::ChainGeometry& geometry) {
  CatchUp();
  plant_->Mount(geometry);
  plant_state_.reset();
  restlessness_.Mount(geometry);
}

mechanics::StackState Axes::Look() {
  return LookBack(queue_.Now());
}

mechanics::StackState Axes::LookBack(Time time) {
  mechanics::StackState state = PlantState();
  restlessness_.AddTo(state, time);
  return state;
}

void Axes::CatchUp() {
  const Time now = queue_.Now();
  if (now == plant_time_) return;
  plant_->Advance(ToSeconds(now - plant_time_));
  plant_state_.reset();
  plant_time_ = now;
}

}  // namespace twinbench::sim
