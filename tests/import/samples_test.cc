#include "tests/import/importing.h"
#include "twin/benches/evaluated.h"
#include "twin/import/import.h"

// The shipped samples, to what the programs beside them hid.
namespace twinbench::imports {
namespace {

nlohmann::json ErrorsOfSample(const std::string& file) {
  const Imported taken = Import({std::string(TWINBENCH_SOURCE_DIR) + "/scenarios/samples/" + file}, LoadMap(""));
  return Evaluated(taken).results.at("errors");
}

/// Within four standard uncertainties, of which the largest is told.
void ExpectHidden(const nlohmann::json& errors, const std::string& key, double value, double largest_u) {
  ASSERT_TRUE(errors.contains(key)) << key;
  const double u = errors.at(key).at("u");
  EXPECT_NEAR(errors.at(key).at("value").get<double>(), value, 4.0 * u) << key;
  EXPECT_LT(u, largest_u) << key;
}

TEST(Samples, OfAPoseTableHaveItsLocations) {
  const nlohmann::json errors = ErrorsOfSample("pose_table.csv");
  for (const auto& [key, value] : {std::pair{"XOC", 12.0}, {"YOC", -7.0}, {"AOC", 9.0}, {"BOC", -3.0}, {"YOA", 8.0},
                                   {"ZOA", -5.0}, {"BOA", 4.0}, {"COA", -6.0}, {"COY", 5.0}, {"BOZ", -4.0},
                                   {"AOZ", 3.0}})
    ExpectHidden(errors, key, value, 0.3);
}

TEST(Samples, OfABarsExportHaveItsErrors) {
  const nlohmann::json errors = ErrorsOfSample("ball_bar.b5r");
  ExpectHidden(errors, "machine.squareness_arcsec", 6.19, 0.1);
  ExpectHidden(errors, "machine.scale_mismatch_um_m", 30.0, 0.5);
  ExpectHidden(errors, "machine.backlash_y_um", 5.0, 0.1);
  ExpectHidden(errors, "machine.backlash_x_um", 0.0, 0.1);
}

/// What the orders leave of a table that goes round once may be more orders as well as noise.
TEST_F(Importing, SaysNothingRepeatsWhereNoPlaceWasReadTwice) {
  const auto summary = [this](bool back) {
    std::string text = "reference [deg],measured [deg]\n";
    const auto add = [&text](int i) { text += fmt::format("{},{:.4f}\n", 2 * i, 2 * i + 0.1 * std::sin(2.0 * i * units::deg) + 0.01 * std::cos(160.0 * i * units::deg)); };
    for (int i = 0; i <= 180; ++i) add(i);
    for (int i = 180; back && i >= 0; --i) add(i);
    const Imported taken = Take(text);
    return EvaluationOf(ParseScenario("bench = \"" + taken.bench + "\"\n", "table", "", taken.set), taken.readings, Estimator::kRigorous).summary;
  };
  EXPECT_THAT(summary(false), testing::AllOf(testing::HasSubstr("left about the orders"), testing::HasSubstr("for no place was read twice"), testing::Not(testing::HasSubstr("repeats to"))));
  EXPECT_THAT(summary(true), testing::HasSubstr("a reading repeats to"));
}

}  // namespace
}  // namespace twinbench::imports
