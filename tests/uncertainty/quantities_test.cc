#include "twin/uncertainty/quantities.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

namespace twinbench::uncertainty {
namespace {

TEST(Quantities, AreTheNumbersWithAnUncertaintyBesideThem) {
  const auto results = nlohmann::json::parse(R"({
    "calibration": {"dof": 12, "gain": {"psd_a_x": {"value": 0.99, "u": 0.01}}},
    "separation": {"target": {"ez_arcsec": [1.0, null, 3.0], "u_ez_arcsec": [0.1, 0.2, 0.3], "position_deg": [0, 1, 2]}},
    "stability": {"standard_deviation": {"dy_um": 0.3}, "u_standard_deviation": {"dy_um": 0.02}, "readings": 5},
    "diagnosis": {"x": {"value": 1.0, "u": 1.0}}})");
  const std::vector<Quantity> found = QuantitiesOf(results);
  ASSERT_EQ(found.size(), 4U);
  EXPECT_EQ(found[0].name, "calibration.gain.psd_a_x");
  EXPECT_EQ(found[0].dof, 12.0);
  EXPECT_EQ(found[1].name, "separation.target.ez_arcsec[0]");
  EXPECT_TRUE(std::isinf(found[1].dof));
  EXPECT_EQ(found[2].name, "separation.target.ez_arcsec[2]") << "what is null was not measured";
  EXPECT_EQ(found[2].u, 0.3);
  EXPECT_EQ(found[3].name, "stability.standard_deviation.dy_um");
  EXPECT_EQ(ListOf(found[2].name), "separation.target.ez_arcsec");
  EXPECT_EQ(KindOf("iso230_2[2].targets[17].mean_arcsec[3]"), "iso230_2[].targets[].mean_arcsec");
}

TEST(Quantities, HaveTheirPartsNearestAbove) {
  const auto json = nlohmann::json::parse(R"({
    "map": {"ez_arcsec": [1.0, 2.0], "u_ez_arcsec": [0.1, 0.2], "u_parts": {"noise": [0.25, 1.0], "drift": [0.75, null]}},
    "table": {"ex_arcsec": [1.0], "u_ex_arcsec": [0.1], "dy_um": [1.0], "u_dy_um": [0.1],
              "u_parts": {"ex_arcsec": {"noise": 1.0}}},
    "errors": {"u_parts": {"noise": 0.5}, "a": {"value": 1.0, "u": 0.1}},
    "plain": {"value": 1.0, "u": 0.1}})");
  const std::vector<Quantity> found = QuantitiesOf(json);
  ASSERT_EQ(found.size(), 6U) << "u_parts is no result";
  const auto parts_of = [&](const std::string& name) {
    std::map<std::string, double> parts;
    for (const Part& p : std::ranges::find(found, name, &Quantity::name)->parts) parts[p.name] = p.share;
    return parts;
  };
  using Parts = std::map<std::string, double>;
  EXPECT_EQ(parts_of("map.ez_arcsec[0]"), (Parts{{"noise", 0.25}, {"drift", 0.75}}));
  EXPECT_EQ(parts_of("map.ez_arcsec[1]"), (Parts{{"noise", 1.0}}));
  EXPECT_EQ(parts_of("table.ex_arcsec[0]"), (Parts{{"noise", 1.0}}));
  EXPECT_EQ(parts_of("table.dy_um[0]"), Parts{}) << "only that of another key is stated";
  EXPECT_EQ(parts_of("errors.a"), (Parts{{"noise", 0.5}}));
  EXPECT_EQ(parts_of("plain"), Parts{});
}

TEST(Quantities, EndInTheirUnits) {
  EXPECT_EQ(UnitOf("separation.target.ez_arcsec[3]"), "arcsec");
  EXPECT_EQ(UnitOf("setups[0].offset_x_um"), "um");
  EXPECT_EQ(UnitOf("calibration.gain.psd_a_x"), "") << "x is no unit";
}

TEST(StatedQuantities, AreThoseWithAnUncertaintyInEachOfItsForms) {
  const auto json = nlohmann::json::parse(R"({"a": {"value": 1, "u": 0.1, "unit": "um"},
    "b": {"value_um": 2, "u_um": 0.2, "bias_um": 9}, "c": {"ez_arcsec": [3, 4], "u_ez_arcsec": [0.3, null],
    "position_deg": [0, 10]}, "d": [{"D_um": 5, "u_D_um": 0.5, "feed": 7}], "dof": 8})");
  std::vector<std::string> names;
  std::vector<double> values;
  for (const Quantity& q : StatedQuantities(json)) {
    names.push_back(q.name);
    values.push_back(q.value);
  }
  EXPECT_THAT(names, testing::ElementsAre("a", "b_um", "c.ez_arcsec[0]", "c.ez_arcsec[1]", "d[0].D_um"));
  EXPECT_THAT(values, testing::ElementsAre(1, 2, 3, 4, 5));
  EXPECT_EQ(QuantitiesOf(json).size(), 4U) << "without the one whose uncertainty is not known";
}

}  // namespace
}  // namespace twinbench::uncertainty
