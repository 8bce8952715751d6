#include "twin/sim/event_queue.h"

#include "twin/core/stream.h"
#include "twin/sim/schedule.h"

namespace twinbench::sim {
namespace {

Time AtNs(std::int64_t ns) { return Time(Duration(ns)); }

TEST(EventQueue, RunsAnEventThatIsAddedForNowAfterThoseThatWaitAlsoFromInsideAnEvent) {
  EventQueue queue;
  std::string seen;
  queue.At(AtNs(5), [&] {
    seen += 'a';
    queue.After(Duration(0), [&] { seen += 'c'; });
  });
  queue.At(AtNs(5), [&] { seen += 'b'; });
  queue.At(AtNs(6), [&] {
    seen += 'd';
    queue.RunUntil(AtNs(20));
    seen += 'f';
  });
  queue.At(AtNs(15), [&] { seen += 'e'; });
  queue.At(AtNs(21), [&] { seen += 'g'; });
  queue.RunUntil(AtNs(10));
  EXPECT_EQ(seen, "abcdef");
  EXPECT_EQ(queue.Now(), AtNs(20));  // never back to 10
}

TEST(EventQueue, RefusesThePast) {
  EventQueue queue;
  queue.RunUntil(AtNs(100));
  EXPECT_THROW(queue.At(AtNs(99), [] {}), std::logic_error);
  EXPECT_THROW(queue.After(Duration(-1), [] {}), std::logic_error);
  EXPECT_THROW(queue.After(Duration::max(), [] {}), std::logic_error);
  EXPECT_THROW(queue.RunUntil(AtNs(99)), std::logic_error);
  EXPECT_EQ(queue.Pending(), 0u);
}

TEST(EventQueue, CannotCancelTheEventThatIsRunningAndStandsStillWhenAllAreCancelled) {
  EventQueue queue;
  EXPECT_FALSE(queue.Cancel(EventId{}));
  EXPECT_TRUE(queue.Cancel(queue.At(AtNs(10), [] {})));
  EXPECT_FALSE(queue.RunOne());
  EXPECT_EQ(queue.Now(), AtNs(0));
  EventId id;
  bool cancelled = true;
  id = queue.At(AtNs(1), [&] { cancelled = queue.Cancel(id); });
  queue.RunOne();
  EXPECT_FALSE(cancelled);
}

TEST(EventQueue, GoesOnAfterAnExceptionInACallback) {
  EventQueue queue;
  int n = 0;
  queue.At(AtNs(1), [] { throw std::runtime_error("device lost"); });
  queue.At(AtNs(2), [&] { ++n; });
  EXPECT_THROW(queue.RunUntil(AtNs(5)), std::runtime_error);
  EXPECT_EQ(queue.Now(), AtNs(1));
  EXPECT_EQ(queue.Pending(), 1u);
  queue.RunUntil(AtNs(5));
  EXPECT_EQ(n, 1);
}

TEST(EventQueue, KeepsNoEventThatRefersToAFrameWhichAnExceptionHasLeft) {
  EventQueue queue;
  Schedule device(queue, "device");
  int n = 0;
  const auto block = [&] {
    ScopedEvents own(device);
    own.At(AtNs(1), [] { throw std::runtime_error("device lost"); });
    own.At(AtNs(3), [&] { ++n; });
    device.RunUntil(AtNs(2), [&] { ++n; });
  };
  EXPECT_THROW(block(), std::runtime_error);
  EXPECT_EQ(queue.Pending(), 0u);
  queue.RunUntil(AtNs(5));
  EXPECT_EQ(n, 0);
}

TEST(EventQueue, DestroysCapturesWhenTheyAreNoLongerNeeded) {
  const auto token = std::make_shared<int>(0);
  {
    EventQueue queue;
    const EventId cancelled = queue.At(AtNs(1), [token] {});
    queue.At(AtNs(2), [token] {});
    queue.At(AtNs(3), [token] {});
    EXPECT_EQ(token.use_count(), 4);
    queue.Cancel(cancelled);
    EXPECT_EQ(token.use_count(), 3);
    queue.RunOne();
    EXPECT_EQ(token.use_count(), 2);
  }
  EXPECT_EQ(token.use_count(), 1);
}

TEST(Callback, KeepsSmallCapturesInsideAndTakesMoveOnlyAndLargeOnes) {
  EventQueue queue;
  int sum = 0;
  std::array<int, 100> large{};
  large[99] = 7;
  queue.After(Duration(1), [&sum, p = std::make_unique<int>(5)] { sum += *p; });
  queue.After(Duration(1), [&sum, large] { sum += large[99]; });
  queue.RunUntil(AtNs(1));
  EXPECT_EQ(sum, 12);
  const auto f = [fits = std::array<char, Callback::kInside>{}] { static_cast<void>(fits); };
  const auto g = [fits_not = std::array<char, Callback::kInside + 1>{}] { static_cast<void>(fits_not); };
  EXPECT_TRUE(Callback::FitsInside<decltype(f)>());
  EXPECT_FALSE(Callback::FitsInside<decltype(g)>());
}

/// The same life in a std::multimap, which keeps equal keys in the order of their insertion.
class EventQueueModel {
 public:
  using Events = std::multimap<Time, int>;
  void Add(Time when, int label) { place_[label] = events_.insert({when, label}); }
  bool Cancel(int label) {
    const auto found = place_.find(label);
    if (found == place_.end()) return false;
    events_.erase(found->second);
    place_.erase(found);
    return true;
  }
  int Next() {  // -1 if there is none
    if (events_.empty()) return -1;
    const int label = events_.begin()->second;
    Cancel(label);
    return label;
  }
  std::size_t size() const { return events_.size(); }

 private:
  Events events_;
  std::map<int, Events::iterator> place_;
};

TEST(EventQueue, BehavesLikeASortedListInARandomLifeAlsoAtEqualTimesAndForOldEvents) {
  Stream random(2025, "event_queue.life");
  EventQueue queue;
  EventQueueModel model;
  std::vector<EventId> ids;
  int ran = -1;
  for (int step = 0; step < 60000; ++step) {
    // Phases of growth, cancelling and draining, so that the sweep of cancelled events comes into play too.
    const std::uint32_t choice = random.Word() % 10, phase = static_cast<std::uint32_t>(step / 1000 % 3);
    if (choice < (phase == 0 ? 7u : 3u)) {
      const Time when = queue.Now() + Duration(random.Word() % 50);  // many equal times
      const int label = static_cast<int>(ids.size());
      ids.push_back(queue.At(when, [&ran, label] { ran = label; }));
      model.Add(when, label);
    } else if (choice < (phase == 1 ? 9u : 7u) && !ids.empty()) {
      const std::size_t label = ids.size() - 1 - random.Word() % std::min<std::size_t>(ids.size(), 400);
      ASSERT_EQ(queue.Cancel(ids[label]), model.Cancel(static_cast<int>(label)));
    } else {
      ran = -1;
      queue.RunOne();
      ASSERT_EQ(ran, model.Next());
    }
    ASSERT_EQ(queue.Pending(), model.size());
  }
  EXPECT_GT(ids.size(), 20000u);
}

}  // namespace
}  // namespace twinbench::sim
