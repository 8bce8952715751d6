#pragma once

#include <string>

namespace twinbench::campaign {

/// A device that is compared in one turn of 36 stops, with a known order and noise.
inline constexpr const char* kSmallScenario = R"(bench = "encoder_comparison"
seed = 3
[device]
noise_deg = 0.001
[encoder_procedure]
kind = "stops"
turns = 1.0
passes = [1, -1]
stops_per_turn = 36
)";

/// A study of it, with these lines after those of its head.
inline std::string StudyOf(const std::string& lines) {
  return "scenario_text = '''\n" + std::string(kSmallScenario) + "'''\n" + lines;
}

}  // namespace twinbench::campaign
