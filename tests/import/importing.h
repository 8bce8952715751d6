#pragma once

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/core/input_error.h"
#include "twin/benches/evaluated.h"
#include "twin/core/units.h"
#include "twin/benches/registry.h"
#include "twin/import/import.h"

namespace twinbench::imports {

/// Files of one test, imported.
class Importing : public ::testing::Test {
 protected:
  std::string File(const std::string& name, const std::string& text) {
    folder_.Write(name, text);
    return folder_.File(name);
  }
  Imported Take(const std::string& text, const std::string& map = "",
                const std::vector<std::string>& columns = {}) {
    return TakeFiles({File("raw.txt", text)}, map, columns);
  }
  /// @param count  So many readings are to come of it.
  Imported TakeReadings(std::size_t count, const std::string& text, const std::string& map = "",
                        const std::vector<std::string>& columns = {}) {
    Imported taken = Take(text, map, columns);
    if (taken.readings.size() != count) throw std::runtime_error(std::to_string(taken.readings.size()) + " readings of\n" + taken.story);
    return taken;
  }
  Imported TakeFiles(const std::vector<std::string>& files, const std::string& map = "",
                     const std::vector<std::string>& columns = {}) {
    return Import(files, MapWith(map, columns));
  }
  /// @param map  The name of a ready map, or a map's text.
  static Map MapWith(const std::string& map, const std::vector<std::string>& columns = {}) {
    Map loaded = map.find('\n') == std::string::npos ? LoadMap(map) : ParseMap(map, "map.toml");
    for (const std::string& column : columns) SetColumn(column, loaded);
    return loaded;
  }

 private:
  TemporaryFolder folder_;
};

/// A text in which all of these stand.
template <class... Words>
auto Says(const Words&... words) {
  return testing::AllOf(testing::HasSubstr(words)...);
}

/// The scenario that is made for what was imported.
inline Scenario Made(const Imported& taken) {
  return ParseScenario("bench = \"" + taken.bench + "\"\n", "raw.csv", "", taken.set);
}
inline report::Evaluation Evaluated(const Imported& taken) {
  return EvaluationOf(Made(taken), taken.readings, Estimator::kRigorous);
}
inline diagnose::Diagnosis Diagnosed(const Imported& taken) {
  return diagnose::Diagnose(taken.readings, Made(taken), {}).diagnosis;
}

inline double Error_deg(const Reading& r) { return (r.measured_rad - r.reference_rad) / units::deg; }

/// The largest measured - reference, whole turns and the mean aside.
inline double Worst_deg(const std::vector<Reading>& readings) {
  double sum = 0.0, worst = 0.0;
  std::vector<double> error;
  for (const Reading& r : readings) {
    error.push_back(std::remainder(r.measured_rad - r.reference_rad, units::turn) / units::deg);
    sum += error.back() / static_cast<double>(readings.size());
  }
  for (const double e : error) worst = std::max(worst, std::abs(e - sum));
  return worst;
}

}  // namespace twinbench::imports
