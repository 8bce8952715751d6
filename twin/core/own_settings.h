#pragma once

#include <any>

#include "twin/core/errors.h"

namespace twinbench {

/// The keys of a bench's own tables, typed by the bench: a value that is copied with its scenario. One that nobody
/// has filled is the bench's defaults.
class OwnSettings {
 public:
  /// @throws std::logic_error if these are another bench's.
  template <class Settings>
  Settings& As() {
    if (!value_.has_value()) value_ = Settings{};
    auto* const own = std::any_cast<Settings>(&value_);
    Require(own, kOfAnother);
    return *own;
  }
  template <class Settings>
  const Settings& As() const {
    static const Settings defaults;
    if (!value_.has_value()) return defaults;
    const auto* const own = std::any_cast<Settings>(&value_);
    Require(own, kOfAnother);
    return *own;
  }

 private:
  static constexpr const char* kOfAnother = "the settings of a scenario were asked for as those of another bench";

  std::any value_;
};

}  // namespace twinbench
