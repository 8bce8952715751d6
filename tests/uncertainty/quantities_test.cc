#include "twin/uncertainty/quantities.h"

#include <gtest/gtest.h>

#include <cmath>
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
}

}  // namespace
}  // namespace twinbench::uncertainty
