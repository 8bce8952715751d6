#pragma once

#include <functional>
#include <set>

#include "hw_bridge/serve/conversation.h"
#include "twin/core/devices.h"

namespace twinbench::hw {

/// Bench time against the wall clock.
///
/// Running: bench time follows the wall clock times `speed`. Held by a client: it passes only in calls that take
/// time, and the wall clock follows: replies are late. Either way `due_` is the wall time at which the bench's
/// present counts as reached. Timeless (speed infinity, or a client said that held time shall cost nothing): nobody
/// waits.
class PacedClock {
 public:
  /// @param simulation  Of the bench; not null.
  /// @param speed       Bench seconds a wall second; infinity: as fast as it goes.
  PacedClock(Clock& clock, Simulation* simulation, double speed, Wall wall = WallClock::now);
  virtual ~PacedClock() = default;

  Time Now() const { return clock_.Now(); }
  double speed() const { return speed_; }
  WallClock::time_point OnTheWall() const { return wall_(); }

  /// Running: brings the bench to where the wall clock is. Called before every look at the bench.
  void CatchUp();
  bool Held() const { return holder_ != nullptr; }
  bool Timeless() const;
  bool HeldByAnother(const void* who) const { return Held() && holder_ != who; }
  /// A call that takes bench time takes it at once; otherwise its end has to be waited for.
  bool Immediate() const { return Held() || Timeless(); }

  /// One client at a time. `who` is any address that identifies a client.
  /// @return false if another one holds it.
  bool Hold(const void* who, bool hold);
  void SetPaced(const void* who, bool paced);
  void Leave(const void* who);
  void Restart();

  /// Runs `call` on the bench; the bench time it takes is booked against the wall clock.
  void Spend(const std::function<void()>& call);
  /// How long the wall clock needs to reach the bench's present.
  WallClock::duration Lag() const;

  /// Lets at most so much bench time pass; true as soon as something has settled.
  using Settles = std::function<bool(Duration)>;
  /// "1" when it has settled, "0" after `within` of bench time.
  Poll Settle(const Settles& settles, Duration within);
  /// "" when so much bench time has passed.
  Poll Pass(Duration duration);
  /// A client that watches something move where time does not pass by itself sees it get on, up to this long.
  void LetGetOn(const Settles& settles);

 protected:
  Clock& clock() { return clock_; }
  /// Lets bench time pass that the wall clock is ahead, and books it.
  virtual void Follow(Duration behind);
  /// What was taken ahead counts no more.
  virtual void ForgetAhead() {}
  void Book(Duration bench_time) { due_ += OnWall(bench_time); }

 private:
  WallClock::duration OnWall(Duration bench_time) const;

  Clock& clock_;
  Simulation* simulation_;
  double speed_;
  Wall wall_;
  WallClock::time_point due_ = wall_();
  const void* holder_ = nullptr;
  std::set<const void*> unpaced_;
};

}  // namespace twinbench::hw
