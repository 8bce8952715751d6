#include "twin/report/page/curves.h"

#include <nlohmann/json.hpp>

#include "twin/report/page/named_numbers.h"
#include "twin/report/page/walk.h"

namespace twinbench::report {

std::vector<PageColumns> VolumetricColumns(const nlohmann::json& results) {
  std::vector<PageColumns> found;
  ForEachObject(results, [&](const std::string& path, const nlohmann::json& object) {
    const auto x = NumbersAt(object, "x_mm"), y = NumbersAt(object, "y_mm"), z = NumbersAt(object, "z_mm");
    if (!x || !y || !z || x->size() != y->size() || x->size() != z->size()) return;
    PageColumns columns{PathInWords(path), "", {{"x", "mm", *x}, {"y", "mm", *y}, {"z", "mm", *z}}};
    for (const auto& [key, value] : object.items()) {
      const auto numbers = NumbersOf(value);
      if (!numbers || numbers->size() != x->size() || key == "x_mm" || key == "y_mm" || key == "z_mm") continue;
      if (columns.colour < 0 && NameAndUnit(key).unit == "µm") columns.colour = static_cast<int>(columns.columns.size());
      columns.columns.push_back({NameAndUnit(key).name, NameAndUnit(key).unit, *numbers});
    }
    if (columns.columns.size() > 3) found.push_back(std::move(columns));
  });
  return found;
}

}  // namespace twinbench::report
