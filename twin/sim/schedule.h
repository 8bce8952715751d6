#pragma once

#include <string>
#include <utility>

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
    At(queue_.Now(), std::forward<F>(f));
    queue_.RunUntil(queue_.Now());
  }

  /// Lets time pass, with everything that happens meanwhile.
  void RunUntil(Time until) { queue_.RunUntil(until); }

  /// The same with an event of its own at the end.
  template <typename F>
  void RunUntil(Time until, F&& f) {
    At(until, std::forward<F>(f));
    queue_.RunUntil(until);
  }

 private:
  EventQueue& queue_;
  std::uint64_t& count_;
};

}  // namespace twinbench::sim
