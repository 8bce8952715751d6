#include "tools/twinbench/alarm_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace twinbench::tools {

const diagnose::ChannelUnit& Watched::UnitOf(const std::string& series) const {
  const auto found = std::ranges::find(channels, series);
  return units.at(found == channels.end() ? 0 : static_cast<std::size_t>(found - channels.begin()));
}

Watched Seen(const diagnose::LinearRun& run, const diagnose::WatchOptions& how) {
  Watched watched{diagnose::Watch(run, how), run.channels, {}};
  for (int c = 0; c < run.Channels(); ++c) watched.units.push_back(run.UnitOf(c));
  return watched;
}

std::string AlarmText(const diagnose::Alarm& alarm, const Watched& watched) {
  const diagnose::ChannelUnit& unit = watched.UnitOf(alarm.series);
  const std::string since = alarm.lasting ? fmt::format("since reading {}", alarm.since) : "in this reading";
  return fmt::format("alarm at reading {}: {} deviates by {:.3g} ± {:.2g} {}, {} (statistic {:.1f}, limit {:.1f})",
                     alarm.reading, alarm.series, alarm.size / unit.to_SI, alarm.u_size / unit.to_SI, unit.name, since,
                     alarm.z, alarm.limit);
}

nlohmann::json AlarmJson(const diagnose::Alarm& alarm, const Watched& watched) {
  const diagnose::ChannelUnit& unit = watched.UnitOf(alarm.series);
  return {{"reading", alarm.reading},
          {"since", alarm.since},
          {"series", alarm.series},
          {"lasting", alarm.lasting},
          {"size_" + unit.name, alarm.size / unit.to_SI},
          {"u_size_" + unit.name, alarm.u_size / unit.to_SI},
          {"statistic", alarm.z},
          {"limit", alarm.limit}};
}

}  // namespace twinbench::tools
