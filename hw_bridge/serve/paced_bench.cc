#include "hw_bridge/serve/paced_bench.h"

#include <algorithm>
#include <cmath>

namespace twinbench::hw {
namespace {

constexpr double kBlock_s = 4e-3;  // of wall time, of the running converter
constexpr double kMostScans = 65536.0;
constexpr Duration kGetOn = std::chrono::milliseconds(50);

/// Thirty years: no client may wait beyond it, or the count of nanoseconds would run over.
constexpr Time kEnd{std::chrono::seconds(1'000'000'000)};

int BlockScans(const AdcSettings& adc, double speed) {
  const double scans = kBlock_s * std::min(speed, 1e3) * adc.rate_Hz / kChannels;
  return static_cast<int>(std::clamp(scans, 1.0, kMostScans));
}

}  // namespace

PacedBench::PacedBench(RotaryBench bench, const AdcSettings& adc, double speed)
    : bench_(bench),
      speed_(speed),
      stream_(bench.adc, bench.clock, adc, BlockScans(adc, std::isfinite(speed) ? speed : 1.0)) {}

bool PacedBench::Timeless() const {
  return std::isinf(speed_) || !unpaced_.empty();
}

void PacedBench::CatchUp() {
  const auto now = WallClock::now();
  if (Timeless()) {
    due_ = now;
  } else if (Held()) {
    due_ = std::max(due_, now);
  } else if (now > due_) {
    const double behind_s = std::chrono::duration<double>(now - due_).count() * speed_;
    Follow(FromSeconds(behind_s));
  }
}

void PacedBench::Follow(Duration behind) {
  if (readers_ > 0) return TakeScans(behind);
  if (behind <= Duration(0)) return;
  bench_.clock.Wait(behind);
  due_ += OnWall(behind);
}

/// Time passes in whole blocks. What nobody can have any more is not converted.
void PacedBench::TakeScans(Duration behind) {
  if (const Duration missed = behind - stream_.HeldAtMost(); missed > stream_.BlockTime()) {
    stream_.Miss(missed);
    due_ += OnWall(missed);
    behind -= missed;
  }
  for (; behind >= stream_.BlockTime(); behind -= stream_.BlockTime()) {
    stream_.TakeNext();
    due_ += OnWall(stream_.BlockTime());
  }
}

WallClock::duration PacedBench::OnWall(Duration bench_time) const {
  return std::chrono::duration_cast<WallClock::duration>(
      std::chrono::duration<double>(ToSeconds(bench_time) / speed_));
}

void PacedBench::Hold(const void* who, bool hold) {
  CatchUp();
  hold ? void(holders_.insert(who)) : void(holders_.erase(who));
  stream_.Forget();
  if (!Held()) due_ = WallClock::now();
}

void PacedBench::SetPaced(const void* who, bool paced) {
  CatchUp();
  paced ? void(unpaced_.erase(who)) : void(unpaced_.insert(who));
  due_ = WallClock::now();
}

/// Nobody has to wait for what a client that has gone has taken.
void PacedBench::Leave(const void* who) {
  if (holders_.contains(who)) Hold(who, false);
  if (unpaced_.contains(who)) SetPaced(who, true);
}

void PacedBench::Restart() {
  bench_.simulation->Restart();
  stream_.Forget();
  due_ = WallClock::now();
}

void PacedBench::Spend(const std::function<void()>& call) {
  CatchUp();
  const Time before = bench_.clock.Now();
  call();
  if (!Timeless()) due_ += OnWall(bench_.clock.Now() - before);
}

WallClock::duration PacedBench::Lag() const {
  return Timeless() ? WallClock::duration::zero() : std::max(due_ - WallClock::now(), WallClock::duration::zero());
}

Poll PacedBench::Settle(RotaryTable& table, Duration within) {
  CatchUp();
  const Time end = std::min(bench_.clock.Now() + within, kEnd);
  return [this, &table, end]() -> std::optional<std::string> {
    CatchUp();
    const Duration left = std::max(end - bench_.clock.Now(), Duration(0));
    bool settled = false;
    Spend([&] { settled = table.Settles(Immediate() ? left : Duration(0)); });
    if (settled) return "1";
    if (Immediate() || left == Duration(0)) return "0";
    return std::nullopt;
  };
}

Poll PacedBench::Pass(Duration duration) {
  CatchUp();
  const Time end = std::min(bench_.clock.Now() + duration, kEnd);
  return [this, end]() -> std::optional<std::string> {
    CatchUp();
    const Duration left = end - bench_.clock.Now();
    if (Immediate() && left > Duration(0)) Spend([&] { bench_.clock.Wait(left); });
    return Immediate() || left <= Duration(0) ? std::optional<std::string>("") : std::nullopt;
  };
}

void PacedBench::LetGetOn(RotaryTable& table) {
  Spend([&] { table.Settles(kGetOn); });
}

}  // namespace twinbench::hw
