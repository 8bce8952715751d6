#include "twin/report/certificate/dsi_unit.h"

#include <map>

namespace twinbench::certificate {

/// @param unit  As in results, "um", or in print, "µm".
std::optional<std::string> DsiUnit(const std::string& unit) {
  static const std::map<std::string, std::string> units = {
      {"", R"(\one)"},
      {"1", R"(\one)"},
      {"arcsec", R"(\arcsecond)"},
      {"deg", R"(\degree)"},
      {"rad", R"(\radian)"},
      {"mrad", R"(\milli\radian)"},
      {"m", R"(\metre)"},
      {"mm", R"(\milli\metre)"},
      {"um", R"(\micro\metre)"},
      {"µm", R"(\micro\metre)"},
      {"nm", R"(\nano\metre)"},
      {"s", R"(\second)"},
      {"ms", R"(\milli\second)"},
      {"V", R"(\volt)"},
      {"mV", R"(\milli\volt)"},
      {"degC", R"(\degreecelsius)"},
      {"°C", R"(\degreecelsius)"},
      {"µm/m", R"(\micro\metre\metre\tothe{-1})"},
      {"µm/K", R"(\micro\metre\kelvin\tothe{-1})"},
      {"µm/m/K", R"(\micro\metre\metre\tothe{-1}\kelvin\tothe{-1})"},
      {"um/m", R"(\micro\metre\metre\tothe{-1})"},
      {"um/K", R"(\micro\metre\kelvin\tothe{-1})"},
      {"um/m/K", R"(\micro\metre\metre\tothe{-1}\kelvin\tothe{-1})"},
      {"mm/min", R"(\milli\metre\minute\tothe{-1})"},
      {"deg/s", R"(\degree\second\tothe{-1})"},
      {"mm⁻²", R"(\milli\metre\tothe{-2})"},
      {"per_mm2", R"(\milli\metre\tothe{-2})"}};
  const auto found = units.find(unit);
  return found == units.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace twinbench::certificate
