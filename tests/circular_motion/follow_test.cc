#include "tests/circular_motion/oracle.h"
#include "twin/benches/circular_motion/twin/factory.h"
#include "twin/core/csv.h"

namespace twinbench::benches::circular {
namespace {

using test::OraclePath, test::QuietCircles;
using units::arcsec, units::deg, units::mm, units::nm, units::um;

// The independent implementation rounds to 0.0001 nm and 0.000001 arcsec; agreement is asked to these.
constexpr double kSame_m = 1.0 * nm, kSame_rad = 1e-4 * arcsec;

/// One point of the table: what is stated, how the machine moves, what is shown.
struct OraclePoint {
  Scenario scenario;
  Reading of_bar, of_grid;  // as they should be
};

OraclePoint PointOf(const CsvTable& table, const CsvTable::Row& row) {
  const auto number = [&](const char* column, double to_SI) {
    return CsvNumber(table, row, *table.Column(column), to_SI);
  };
  QuietCircles quiet;
  std::stringstream parameters(row.fields[*table.Column("parameters")]);
  for (std::string one; std::getline(parameters, one, ';');)
    quiet.Set(one.substr(0, one.find('=')), std::stod(one.substr(one.find('=') + 1)));
  Reading r;
  const double radius_m = number("radius_mm", mm), commanded_rad = number("commanded_deg", deg);
  r.direction = static_cast<int>(number("direction", 1.0));
  r.temperature_degC = 20.0 + number("temperature_minus_20_K", 1.0);
  kCommandedX_m(r) = radius_m * std::cos(commanded_rad);
  kCommandedY_m(r) = radius_m * std::sin(commanded_rad);
  kFeed_m_s(r) = number("feed_mm_min", mm / 60.0);
  OraclePoint point{quiet.Make(), r, r};
  kBar_m(point.of_bar) = number("bar_um", um);
  kEncoder_rad(point.of_bar) = number("encoder_deg", deg);
  kGridX_m(point.of_grid) = number("grid_x_mm", mm);
  kGridY_m(point.of_grid) = number("grid_y_mm", mm);
  return point;
}

Deviation Predicted(const Scenario& scenario, const Reading& reading) {
  const Eigen::MatrixXd shown_m = FollowRecord(scenario, {reading})->Predict({});
  return {shown_m(0, 0), shown_m(0, 1)};
}

TEST(CircularFollow, ShowsWhatAnIndependentImplementationShows) {
  const CsvTable table = ReadCsv(OraclePath("circular_points.csv"));
  ASSERT_EQ(table.rows.size(), 252U);
  for (const CsvTable::Row& row : table.rows) {
    const OraclePoint point = PointOf(table, row);
    const Reading bar = WithAngles({point.of_bar}).front(), grid = WithAngles({point.of_grid}).front();
    const Deviation by_bar = Predicted(point.scenario, bar), by_grid = Predicted(point.scenario, grid);
    EXPECT_NEAR(by_bar.radial_m, DeviationOf(bar).radial_m, kSame_m) << table.Where(row);
    EXPECT_NEAR(by_bar.tangential_m, DeviationOf(bar).tangential_m, kSame_rad * Radius_m(bar)) << table.Where(row);
    EXPECT_NEAR(by_grid.radial_m, DeviationOf(grid).radial_m, kSame_m) << table.Where(row);
    EXPECT_NEAR(by_grid.tangential_m, DeviationOf(grid).tangential_m, kSame_m) << table.Where(row);
  }
}

/// Values of the set-ups, one a reading.
Eigen::VectorXd BySetup(const std::vector<Reading>& record, const std::vector<double>& values) {
  Eigen::VectorXd all(std::ssize(record));
  for (std::size_t i = 0; i < record.size(); ++i)
    all[static_cast<Eigen::Index>(i)] = values[static_cast<std::size_t>(record[i].setup)];
  return all;
}

TEST(CircularFollow, FollowsARunOfAnIndependentImplementation) {
  const std::vector<Reading> record = WithAngles(test::OracleCircles());
  const nlohmann::json truth = test::OracleCirclesTruth();
  QuietCircles quiet;
  for (const auto& [name, value] : truth["parameters"].items()) {
    if (value.is_number() && !name.starts_with("grid_rotation") && !name.starts_with("grid_offset"))
      quiet.Set(name, value.get<double>());
  }
  const nlohmann::json& p = truth["parameters"];
  const auto& zero_deg = truth["encoder_zero_deg"];
  const auto& length_um = truth["bar_length_error_um"];
  const double x_um = p["grid_offset_x_um"], y_um = p["grid_offset_y_um"], turn = p["grid_rotation_arcsec"];
  const std::vector<model::Disturbance> mounted = {
      {"offset_x", um * BySetup(record, {p["offset_x_um"][0], p["offset_x_um"][1], x_um})},
      {"offset_y", um * BySetup(record, {p["offset_y_um"][0], p["offset_y_um"][1], y_um})},
      {"rotation", BySetup(record, {zero_deg[0].get<double>() * deg, zero_deg[1].get<double>() * deg, turn * arcsec})},
      // That implementation adds what a set-up draws of the length behind the transducer's gain.
      {"radial", -um * BySetup(record, {length_um[0], length_um[1], 0.0})}};
  const Eigen::MatrixXd shown_m = FollowRecord(quiet.Make(), record)->Predict(mounted);
  for (std::size_t i = 0; i < record.size(); ++i) {
    const Deviation expected = DeviationOf(record[i]);
    const auto row = static_cast<Eigen::Index>(i);
    EXPECT_NEAR(shown_m(row, 0), expected.radial_m, kSame_m) << "reading " << i;
    EXPECT_NEAR(shown_m(row, 1), expected.tangential_m, kSame_m) << "reading " << i;
  }
}

}  // namespace
}  // namespace twinbench::benches::circular
