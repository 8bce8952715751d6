#include "hw_bridge/watched_adc.h"

#include <fmt/format.h>

#include <cmath>
#include <thread>

#include "twin/core/device_fault.h"
#include "twin/core/units.h"

namespace twinbench::hw {
namespace {

constexpr auto kBetweenLooksAtEncoders = std::chrono::milliseconds(20);

}  // namespace

Acquisition WatchedAdc::Acquire(int n_samples, bool keep_raw) {
  failure_ = nullptr;
  Acquisition block;
  {
    const std::jthread looks([this](const std::stop_token& token) { LookWhile(token); });
    block = inner_.Acquire(n_samples, keep_raw);
  }  // asked to stop, and joined: nobody else speaks to the tables from here on
  if (failure_) std::rethrow_exception(failure_);
  return block;
}

void WatchedAdc::LookWhile(const std::stop_token& block_lasts) {
  try {
    do {
      for (StandingTable& table : tables_) Look(table);
      std::unique_lock lock(mutex_);
      ended_.wait_for(lock, block_lasts, kBetweenLooksAtEncoders, [] { return false; });
    } while (!block_lasts.stop_requested());
  } catch (...) {  // told where the block is handed over
    failure_ = std::current_exception();
  }
}

void WatchedAdc::Look(StandingTable& table) {
  const TableState state = table.table.State();
  if (!state.referenced)
    throw DeviceFault(FaultKind::kRestarted, table.name, "lost its origin while a block was taken");
  const double off_rad = state.encoder_rad - state.commanded_rad;
  if (!(std::abs(off_rad) > std::abs(table.furthest_rad))) return;
  if (std::abs(off_rad) > table.tolerance_rad)
    throw DeviceFault(FaultKind::kMoved, table.name,
                      fmt::format("left its measuring position, {:.6f} deg, while a block was taken: {:.3g} arcsec off, and {:.3g} are allowed",
                                  state.commanded_rad / units::deg, off_rad / units::arcsec,
                                  table.tolerance_rad / units::arcsec));
  table.furthest_rad = off_rad;
}

}  // namespace twinbench::hw
