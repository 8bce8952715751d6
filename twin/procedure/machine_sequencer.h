#pragma once

#include <optional>

#include "twin/procedure/machine_options.h"
#include "twin/procedure/stood.h"
#include "twin/procedure/turning.h"
#include "twin/procedure/whereabouts.h"

namespace twinbench::procedure {

/// What a run is to take: every reading with its commanded coordinates and the time at which it is due.
struct MachinePlan {
  std::vector<Reading> readings;
  std::string bench;                            // whose columns they are
  std::function<void(Reading&)> complete = {};  // a reading that has just been taken; none: it is whole
};

/// How far a run has come, over all attempts.
struct MachineRunState {
  std::vector<Reading> kept;
  std::optional<int> mounted;  // set-up, on a real bench: a mounting outlives the fault that came after it
  bool lost_origin = false;    // behind a restart of a real bench's controller
  bool is_doubted = false;     // behind a fault: whether a real bench still shows at a place what it showed
};

/// Whether the last reading can be taken again.
bool CanProve(const MachineRunState& state, const MachineOptions& options);

/// The steps that all runs of machines share: mount, go somewhere, go round, take readings.
///
/// On a simulated bench every attempt goes the whole way from the start; readings that are kept already must come
/// out the same and are not kept again. A real bench goes on with the first reading that is missing; behind a fault with the one
/// before, if it was taken at rest and nothing else has been mounted since, which is not kept again.
class MachineSequencer {
 public:
  MachineSequencer(MachineBench bench, const MachinePlan& plan, ReadingSink& sink, const MachineOptions& options,
                   const ProgressCallback& progress, MachineRunState& state);

  const std::vector<Reading>& plan() const { return plan_.readings; }
  const std::vector<MachineAxis>& axes() const { return bench_.machine.Axes(); }
  bool IsSimulated() const { return bench_.simulation != nullptr; }
  Time Now() const { return bench_.clock.Now(); }
  /// Where the axes stand, by their encoders.
  std::vector<double> Where();
  /// Where their controller has sent them: its targets, or their encoders where it tells none.
  std::vector<double> WhereSent();

  /// The first reading of [first, end) that is to be gone for; `end` if there is none.
  int From(int first, int end) const;
  /// One pass after the other, where passes are numbered through the whole plan: the readings [first, end) of each that
  /// are to be gone for.
  void ThroughPasses(const std::function<void(int first, int end)>& take);
  /// Whether the set-up has to be mounted first.
  bool NeedsMounting(int setup) const { return state_.mounted != setup; }
  /// Whether anything stands in the way that was mounted for another set-up.
  bool HasMounted() const { return state_.mounted.has_value(); }
  /// Takes off what is mounted.
  void Clear();
  void Mount(int setup, const std::string& what);
  /// Lets time pass.
  void Pause(Duration duration);
  void PauseUntil(Time when) { Pause(when - Now()); }
  /// What a hand needs passes on a simulated bench; on a real one it takes the time that it takes.
  void LetHandsWork(Duration duration);
  /// Waits until the bench has rested so long since the last reading that was due before `reading`.
  void Rest(int reading, Duration duration);

  /// Goes straight to a place, as fast as the machine goes.
  void MoveTo(const std::vector<double>& to);
  /// The same while the indexer turns its table; behind it where somebody does that by hand.
  /// @throws DeviceFault kRefused if the bench has no indexer.
  void MoveAndIndex(const std::vector<double>& to, int tooth, double tooth_rad);
  /// Goes round without taking anything.
  void Go(const Arc& arc);
  /// Goes round; the arc's triggers take the readings [first, end), which are kept if they are proved where it ends.
  /// @param stands  There: a reading that shows nothing yet.
  /// @throws DeviceFault kFollowing for one that is not gone round at its feed, within a tenth; what Watch throws.
  void Sweep(const Arc& arc, int first, int end, const Reading& stands);
  /// Lets an axis go over to a speed; returns at once.
  void StartTurning(std::size_t axis, double speed_rad_s, Duration ramp);
  /// The same, and waits until it has.
  void Turn(std::size_t axis, double speed_rad_s, Duration ramp);
  /// Takes the readings [first, end) from the instruments' memory, one at every so many lines of the encoder that they
  /// count, while an axis turns.
  /// @param poll  From look to look.
  /// @throws DeviceFault kOverrun if their memory ran full between two looks; kStalled if nothing comes for a minute; kStalled,
  ///         kFollowing for an axis that does not turn as it was told.
  void Collect(int first, int end, int lines, Duration poll);
  /// Takes a reading when it is due, and so long behind the end of the last move that nothing settles any more.
  /// @param enter  What the way knows by now and the plan did not.
  void TakeAtRest(int reading, Duration dwell, const std::function<void(Reading&)>& enter = {});
  /// Takes a reading at an instant while an axis turns, which is looked at behind it.
  /// @param late  Behind `due`: what the bench may be.
  /// @throws DeviceFault kOverrun for a bench that is later; kStalled, kFollowing for an axis that does not turn as it was told;
  ///         kLimit, kRestarted, kRefused as RequireMayTurn.
  void TakeInMotion(int reading, Time due, Duration late, const std::function<void(Reading&)>& enter = {});
  /// What the instruments show on the way to a reading.
  Reading Look();

  /// Whether anything was told to turn on and on.
  bool HasTurned() const { return turning_.WasTold(); }
  /// Keeps what has been taken. Called by itself every now and then; to be called at the end and behind a fault.
  void Flush();

 private:
  void Index(int tooth, double tooth_rad);
  /// @param meanwhile  Once the move has begun.
  void Move(const std::vector<double>& to, const std::function<void()>& meanwhile);
  void Arm(int samples, int lines);
  LatchedSamples Latched();
  void WaitUntilDue(int reading, Duration dwell);
  Reading ReadAtRest(std::vector<Stood>& stood);
  void LookAtAxes(std::vector<Stood>& stood, double Stood::*when);
  std::vector<AxisState> LookBeforeMotion();
  AxisState LookAtTurning();
  void RequirePace(const Arc& arc, double radius_m, const std::vector<Reading>& samples) const;
  std::vector<Reading> SamplesAlong(const Arc& arc, std::size_t triggers);
  void Keep(int reading, const Reading& sample, const std::function<void(Reading&)>& enter = {});
  void KeepAndHear(int reading, const Reading& sample, const std::function<void(Reading&)>& enter = {});
  bool IsLast(int reading) const { return reading + 1 == static_cast<int>(plan().size()); }
  Reading Joined(const Reading& planned, const Reading& sample) const;
  void RequireSame(const Reading& reading) const;
  double PathTime_s(const Arc& arc, double radius_m) const;
  std::size_t Together() const;

  MachineBench bench_;
  const MachinePlan& plan_;
  ReadingSink& sink_;
  const MachineOptions& options_;
  const ProgressCallback& progress_;
  MachineRunState& state_;
  std::vector<Reading> taken_;  // not yet kept
  Time armed_{};                // when the instruments last were
  Whereabouts where_;
  Turning turning_;  // of the first axis
};

/// For a bench of one axis that turns.
/// @param axis  What it is: "the turntable".
/// @throws DeviceFault kRefused if the machine is another.
void RequireOneRotaryAxis(const std::vector<MachineAxis>& axes, const std::string& axis);

/// The way of one bench through its plan.
using MachineWay = std::function<void(MachineSequencer&)>;

/// Carries out a plan on any such bench: the twin or hardware. Every reading goes to `sink`, those of a sweep some
/// at a time.
///
/// A fault of a device costs an attempt: the machine is stopped, what was taken is kept, and the way to the next
/// reading is gone again; behind a restart of a real bench's controller its origins are found first, if `options.may_home`
/// and nothing is mounted on linear axes. Stalls, limits, refusals and the operator end the run at once; it can be resumed.
/// @throws DeviceFault when no attempt is left or the fault is none to try again; the machine was told to stop.
///         InputError if a simulated bench does not make the readings again that are kept.
void CarryOutPlan(MachineBench& bench, const MachinePlan& plan, const MachineWay& way, ReadingSink& sink,
                  const ProgressCallback& progress, const MachineOptions& options);

}  // namespace twinbench::procedure
