#pragma once

#include <string>
#include <utility>
#include <vector>

#include "twin/sim/event_queue.h"

namespace twinbench::sim {

/// A device's way to the event queue: what it schedules is counted under its name.
class Schedule {
 public:
  Schedule(EventQueue& queue, const std::string& device) : queue_(queue), count_(queue.CountOf(device)) {}

  Time Now() const { return queue_.Now(); }

  /// @throws std::logic_error if `when` has passed.
  template <typename F>
  EventId At(Time when, F&& f) {
    ++count_;
    return queue_.At(when, std::forward<F>(f));
  }

  /// What a device does at once, in its turn among what else happens now.
  template <typename F>
  void Now(F&& f) {
    RunUntil(queue_.Now(), std::forward<F>(f));
  }

  /// Lets time pass, with everything that happens meanwhile.
  void RunUntil(Time until) { queue_.RunUntil(until); }

  /// The same with an event of its own at the end, which an exception before it takes back.
  template <typename F>
  void RunUntil(Time until, F&& f);

  void Cancel(EventId id) { queue_.Cancel(id); }

 private:
  EventQueue& queue_;
  std::uint64_t& count_;
};

/// Events that refer to locals of whoever makes them: those that have not run when this goes out of scope, by an
/// exception above all, are cancelled, so that no later event finds a frame that is gone.
class ScopedEvents {
 public:
  explicit ScopedEvents(Schedule& schedule) : schedule_(schedule) {}
  ~ScopedEvents() {
    for (const EventId& id : ids_) schedule_.Cancel(id);
  }
  ScopedEvents(const ScopedEvents&) = delete;
  ScopedEvents& operator=(const ScopedEvents&) = delete;

  /// As Schedule::At.
  template <typename F>
  void At(Time when, F&& f) {
    ids_.push_back(schedule_.At(when, std::forward<F>(f)));
  }

 private:
  Schedule& schedule_;
  std::vector<EventId> ids_;
};

template <typename F>
void Schedule::RunUntil(Time until, F&& f) {
  ScopedEvents event(*this);
  event.At(until, std::forward<F>(f));
  queue_.RunUntil(until);
}

}  // namespace twinbench::sim
