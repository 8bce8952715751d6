#include "hw_bridge/serve/paced_clock.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace twinbench::hw {
namespace {

constexpr Duration kGetOn = std::chrono::milliseconds(50);

/// Thirty years: no client may wait beyond it, or the count of nanoseconds would run over.
constexpr Time kEnd{std::chrono::seconds(1'000'000'000)};

}  // namespace

PacedClock::PacedClock(Clock& clock, Simulation* simulation, double speed, Wall wall)
    : clock_(clock), simulation_(simulation), speed_(speed), wall_(std::move(wall)) {}

bool PacedClock::Timeless() const {
  return std::isinf(speed_) || !unpaced_.empty();
}

void PacedClock::CatchUp() {
  const auto now = OnTheWall();
  if (Timeless()) {
    due_ = now;
  } else if (Held()) {
    due_ = std::max(due_, now);
  } else if (now > due_) {
    const double behind_s = std::chrono::duration<double>(now - due_).count() * speed_;
    Follow(FromSeconds(behind_s));
  }
}

void PacedClock::Follow(Duration behind) {
  if (behind <= Duration(0)) return;
  clock_.Wait(behind);
  Book(behind);
}

WallClock::duration PacedClock::OnWall(Duration bench_time) const {
  return std::chrono::duration_cast<WallClock::duration>(
      std::chrono::duration<double>(ToSeconds(bench_time) / speed_));
}

bool PacedClock::Hold(const void* who, bool hold) {
  if (HeldByAnother(who)) return !hold;
  CatchUp();
  holder_ = hold ? who : nullptr;
  ForgetAhead();
  if (!Held()) due_ = OnTheWall();
  return true;
}

void PacedClock::SetPaced(const void* who, bool paced) {
  CatchUp();
  paced ? void(unpaced_.erase(who)) : void(unpaced_.insert(who));
  due_ = OnTheWall();
}

/// Nobody has to wait for what a client that has gone has taken.
void PacedClock::Leave(const void* who) {
  if (holder_ == who) Hold(who, false);
  if (unpaced_.contains(who)) SetPaced(who, true);
}

void PacedClock::Restart() {
  simulation_->Restart();
  ForgetAhead();
  due_ = OnTheWall();
}

void PacedClock::Spend(const std::function<void()>& call) {
  CatchUp();
  const Time before = clock_.Now();
  call();
  if (!Timeless()) Book(clock_.Now() - before);
}

WallClock::duration PacedClock::Lag() const {
  return Timeless() ? WallClock::duration::zero() : std::max(due_ - OnTheWall(), WallClock::duration::zero());
}

Poll PacedClock::Settle(const Settles& settles, Duration within) {
  CatchUp();
  const Time end = std::min(clock_.Now() + within, kEnd);
  return [this, settles, end]() -> std::optional<std::string> {
    CatchUp();
    const Duration left = std::max(end - clock_.Now(), Duration(0));
    bool settled = false;
    Spend([&] { settled = settles(Immediate() ? left : Duration(0)); });
    if (settled) return "1";
    if (Immediate() || left == Duration(0)) return "0";
    return std::nullopt;
  };
}

Poll PacedClock::Pass(Duration duration) {
  CatchUp();
  const Time end = std::min(clock_.Now() + duration, kEnd);
  return [this, end]() -> std::optional<std::string> {
    CatchUp();
    const Duration left = end - clock_.Now();
    if (Immediate() && left > Duration(0)) Spend([&] { clock_.Wait(left); });
    return Immediate() || left <= Duration(0) ? std::optional<std::string>("") : std::nullopt;
  };
}

void PacedClock::LetGetOn(const Settles& settles) {
  Spend([&] { settles(kGetOn); });
}

}  // namespace twinbench::hw
