#include "twin/report/far_readings.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "twin/core/units.h"
#include "twin/report/json_units.h"

namespace twinbench::report {

std::string FarText(const std::vector<separate::FarOnCourse>& far, const char* which, const char* unit, double unit_SI) {
  std::string text;
  for (const separate::FarOnCourse& one : far)
    text += fmt::format("doubtful: {} lies {:.3g} {} from the curve through its neighbours, {:.2g} times the scatter of the others, "
                        "and no other turn does: left out\n",
                        fmt::format(fmt::runtime(which), one.reading, one.angle_rad / units::deg), one.off / unit_SI, unit, one.times);
  return text;
}

nlohmann::json FarJson(const std::vector<separate::FarOnCourse>& far, const char* off, double unit_SI) {
  nlohmann::json all = nlohmann::json::array();
  for (const separate::FarOnCourse& one : far)
    all.push_back({{"reading", one.reading}, {"angle_deg", one.angle_rad / units::deg}, {off, In(unit_SI, one.off)}, {"times_scatter", one.times}});
  return all;
}

}  // namespace twinbench::report
