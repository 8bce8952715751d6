#include "twin/sim/event_queue.h"

#include <algorithm>
#include <limits>

#include "twin/core/errors.h"

namespace twinbench::sim {

bool EventQueue::IsLater(const Entry& a, const Entry& b) {
  return a.when != b.when ? a.when > b.when : a.sequence > b.sequence;
}

Time EventQueue::AfterNow(Duration delay) const {
  Require(delay >= Duration::zero(), "an event cannot be added in the past");
  Require(delay <= Time::max() - now_ || now_ < Time{}, "an event lies beyond the range of the clock");
  return now_ + delay;
}

EventId EventQueue::Add(Time when, Callback callback) {
  Require(when >= now_, "an event cannot be added in the past");
  const EventId id = {++last_sequence_, FreeSlot()};
  slots_[id.slot].callback = std::move(callback);
  slots_[id.slot].sequence = id.sequence;
  heap_.push_back({when, id.sequence, id.slot});
  std::push_heap(heap_.begin(), heap_.end(), IsLater);
  return id;
}

std::uint32_t EventQueue::FreeSlot() {
  if (free_slots_.empty()) {
    Require(slots_.size() < std::numeric_limits<std::uint32_t>::max(), "too many events are pending");
    slots_.emplace_back();
    return static_cast<std::uint32_t>(slots_.size() - 1);
  }
  const std::uint32_t slot = free_slots_.back();
  free_slots_.pop_back();
  return slot;
}

Callback EventQueue::Vacate(std::uint32_t slot) {
  slots_[slot].sequence = 0;
  free_slots_.push_back(slot);
  return std::move(slots_[slot].callback);
}

bool EventQueue::Cancel(EventId id) {
  if (id.sequence == 0 || id.slot >= slots_.size() || slots_[id.slot].sequence != id.sequence) return false;
  // Destroyed at the end, when the queue is in order again: its captures may call us.
  const Callback callback = Vacate(id.slot);
  ++n_cancelled_;
  if (n_cancelled_ > 64 && n_cancelled_ > heap_.size() / 2) DropCancelledEverywhere();
  return true;
}

void EventQueue::DropTop() {
  std::pop_heap(heap_.begin(), heap_.end(), IsLater);
  heap_.pop_back();
}

void EventQueue::DropCancelledTop() {
  while (!heap_.empty() && IsCancelled(heap_.front())) {
    DropTop();
    --n_cancelled_;
  }
}

void EventQueue::DropCancelledEverywhere() {
  std::erase_if(heap_, [this](const Entry& entry) { return IsCancelled(entry); });
  std::make_heap(heap_.begin(), heap_.end(), IsLater);
  n_cancelled_ = 0;
}

bool EventQueue::RunOne() {
  DropCancelledTop();
  if (heap_.empty()) return false;
  const Entry next = heap_.front();
  DropTop();
  now_ = next.when;
  Callback callback = Vacate(next.slot);
  callback();
  return true;
}

void EventQueue::RunUntil(Time until) {
  Require(until >= now_, "the clock cannot run backwards");
  DropCancelledTop();
  while (!heap_.empty() && heap_.front().when <= until) {
    RunOne();
    DropCancelledTop();
  }
  now_ = std::max(now_, until);
}

}  // namespace twinbench::sim
