#pragma once

#include <fstream>
#include <nlohmann/json.hpp>

#include "twin/benches/circular_motion/settings.h"
#include "twin/core/reading.h"

/// Points and a run by an independent implementation of the same definitions, and what tests make of them.
namespace twinbench::test {

inline std::string OraclePath(const std::string& name) {
  return std::string(TWINBENCH_TEST_DATA) + "/oracle/" + name;
}

inline std::vector<Reading> OracleCircles() {
  return ReadReadingsCsv(OraclePath("circular_run.csv"), "circular_motion");
}
inline nlohmann::json OracleCirclesTruth() {
  return nlohmann::json::parse(std::ifstream(OraclePath("circular_run_truth.json")));
}

/// A bench without any error, and one key after the other.
class QuietCircles {
 public:
  QuietCircles() : text_("bench = \"circular_motion\"\n[machine]\nlag_x_s = 0.0\nlag_y_s = 0.0\n") {}

  /// Of a parameter as the independent implementation calls it.
  static std::string KeyOf(const std::string& name) {
    static const std::map<std::string, std::string> renamed = {
        {"zero_deg", "encoder.zero_deg"},
        {"ecc_arcsec", "encoder.eccentricity_arcsec"},
        {"ecc_azimuth_deg", "encoder.eccentricity_azimuth_deg"},
        {"ell_arcsec", "encoder.ellipticity_arcsec"},
        {"ell_azimuth_deg", "encoder.ellipticity_azimuth_deg"},
        {"bar_gain", "bar.gain_error"},
        {"encoder_latency_s", "encoder.latency_s"}};
    return renamed.contains(name) ? renamed.at(name) : TableOf(name);
  }
  void Set(const std::string& name, double value) {
    overrides_.push_back(KeyOf(name) + "=" + std::to_string(value));
  }

  Scenario Make() const { return ParseScenario(text_, "quiet", ".", overrides_); }

 private:
  /// With the table in front.
  static std::string TableOf(const std::string& name) {
    const auto begins = [&](const char* with) { return name.starts_with(with); };
    if (begins("bar_")) return "bar." + name.substr(4);
    if (begins("grid_")) return "grid." + name.substr(5);
    if (begins("offset") || begins("ball") || begins("length") || begins("height")) return "bar." + name;
    return (begins("tilt") ? "encoder." : "machine.") + name;
  }

  std::string text_;
  std::vector<std::string> overrides_;
};

}  // namespace twinbench::test
