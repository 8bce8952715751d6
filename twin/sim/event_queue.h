#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "twin/core/time.h"
#include "twin/sim/callback.h"

namespace twinbench::sim {

/// Names one event of one queue; worth nothing once the event has run or was cancelled, and never reused.
struct EventId {
  std::uint64_t sequence = 0;  // 0: no event
  std::uint32_t slot = 0;
};

/// The virtual clock of the twin and what will happen at which of its nanoseconds.
///
/// Events run in the order of their time, and in the order in which they were added where times are equal. A
/// callback may add and cancel events and may run the queue itself (that is how a blocking device call inside an
/// event works). If it throws, the exception passes through the Run call; the event counts as run and the queue
/// goes on with the next one when asked.
class EventQueue {
 public:
  EventQueue() = default;
  EventQueue(const EventQueue&) = delete;
  EventQueue& operator=(const EventQueue&) = delete;

  Time Now() const { return now_; }
  std::size_t Pending() const { return heap_.size() - n_cancelled_; }

  /// How many events each device has scheduled so far, by its name (schedule.h).
  const std::map<std::string, std::uint64_t>& Scheduled() const { return scheduled_; }
  /// A device's count; lives as long as the queue.
  std::uint64_t& CountOf(const std::string& device) { return scheduled_[device]; }

  /// Lets `f()` be called at `when`. O(log n); no allocation for captures up to Callback::kInside bytes.
  /// @throws std::logic_error if `when` has passed.
  template <typename F>
  EventId At(Time when, F&& f) {
    return Add(when, Callback(std::forward<F>(f)));
  }
  /// @throws std::logic_error if `delay` is negative or ends beyond the clock's range (292 years).
  template <typename F>
  EventId After(Duration delay, F&& f) {
    return Add(AfterNow(delay), Callback(std::forward<F>(f)));
  }

  /// Takes the event back and destroys its callback. O(1), amortised.
  /// @return false if it has run, is running or was cancelled before.
  bool Cancel(EventId id);

  /// Runs the next event. @return false if there is none.
  bool RunOne();

  /// Runs every event up to and including `until`, also those added meanwhile; the clock then shows `until`.
  /// @throws std::logic_error if `until` has passed.
  void RunUntil(Time until);

 private:
  struct Entry {
    Time when;
    std::uint64_t sequence;
    std::uint32_t slot;
  };
  struct Slot {
    std::uint64_t sequence = 0;  // of the event that lives here; 0: free
    Callback callback;
  };
  static bool IsLater(const Entry& a, const Entry& b);

  EventId Add(Time when, Callback callback);
  Time AfterNow(Duration delay) const;
  std::uint32_t FreeSlot();
  Callback Vacate(std::uint32_t slot);
  bool IsCancelled(const Entry& entry) const { return slots_[entry.slot].sequence != entry.sequence; }
  void DropTop();
  void DropCancelledTop();
  void DropCancelledEverywhere();

  Time now_{};
  std::map<std::string, std::uint64_t> scheduled_;
  std::uint64_t last_sequence_ = 0;
  std::vector<Entry> heap_;  // of live and cancelled events, the next one first
  std::size_t n_cancelled_ = 0;
  std::vector<Slot> slots_;
  std::vector<std::uint32_t> free_slots_;
};

}  // namespace twinbench::sim
