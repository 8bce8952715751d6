#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

/// Numbers of results.json and what their keys say about them.
namespace twinbench::report {

/// "ez_arcsec" is the quantity "ez" in "arcsec", "scale_um_m" the "scale" in "um/m"; underscores of the rest become spaces. A list
/// "ez_arcsec[]" is called like one of its numbers.
struct NamedUnit {
  std::string name, unit;
};
NamedUnit NameAndUnit(const std::string& path);

/// @return the numbers of a list, null as NaN; nothing if it is no list, empty, or holds anything else.
std::optional<std::vector<double>> NumbersOf(const nlohmann::json& node);

/// @return the numbers of member `key`, or nothing.
std::optional<std::vector<double>> NumbersAt(const nlohmann::json& object, const std::string& key);

/// "separation.target" as a person says it: "target". What only says where in the file it stood is left out.
std::string PathInWords(const std::string& path);

/// The same with a quantity as the field calls them: "separation.target", "ez" are "Table under test: index error EZ".
/// @param name  Of the quantity; empty: it is the last word of the path.
std::string CurveTitle(const std::string& path, const std::string& name);

/// "um" as people read it: "µm".
std::string UnitText(const std::string& unit);

/// Likewise; degrees as their sign.
std::string ShownUnit(const std::string& unit);

/// A unit as it stands behind a number: all but the degree of an angle keep their distance.
std::string AfterNumber(const std::string& shown_unit);

/// A number of an object; NaN if it has none of that name.
double NumberAt(const nlohmann::json& object, const std::string& key);

/// A text of an object; empty if it has none of that name.
std::string TextAt(const nlohmann::json& object, const std::string& key);

/// A number with as many digits as `u` makes sense of (two of `u`), or six if there is no u.
std::string NumberText(double value);
std::string NumberText(double value, double u);

/// "−2.50 ± 0.67 arcsec", with a true minus.
/// @param u  Standard or expanded; NaN: none is stated.
std::string MeasuredText(double value, double u, const std::string& unit);

}  // namespace twinbench::report
