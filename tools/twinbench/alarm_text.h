#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "twin/diagnose/watch.h"

namespace twinbench::tools {

/// What a watch has seen, with the units of its channels.
struct Watched {
  diagnose::WatchReport report;
  std::vector<std::string> channels;
  std::vector<diagnose::ChannelUnit> units;  // of each channel

  /// Of a channel; of a pattern that of the first.
  const diagnose::ChannelUnit& UnitOf(const std::string& series) const;
};

Watched Seen(const diagnose::LinearRun& run, const diagnose::WatchOptions& how);

/// "alarm at reading 84: psd_a_x deviates by ...", one line without its end.
std::string AlarmText(const diagnose::Alarm& alarm, const Watched& watched);
nlohmann::json AlarmJson(const diagnose::Alarm& alarm, const Watched& watched);

}  // namespace twinbench::tools
