#include "tests/import/importing.h"

/// Two files that are the two sides of one comparison, without a clock or names that would say so.
namespace twinbench::imports {
namespace {

using testing::AllOf, testing::HasSubstr, testing::Not;

/// 40 rows of `columns` angles; each column another course, `off` further.
std::string Matrix(int columns, double off) {
  std::string text;
  for (int i = 0; i < 40; ++i) {
    for (int c = 0; c < columns; ++c) text += fmt::format("{}{:.4f}", c > 0 ? " " : "", (20.0 + 5.0 * c) * std::sin(1.3 * i + c) + off * (c + 1));
    text += "\n";
  }
  return text;
}

/// The mean of measured - reference [deg].
double Mean_deg(const Imported& taken) {
  double sum = 0.0;
  for (const Reading& r : taken.readings) sum += (r.measured_rad - r.reference_rad) / units::deg;
  return sum / static_cast<double>(taken.readings.size());
}

TEST_F(Importing, TakesMatricesOfJointsByTheNamesOfTheirFiles) {
  const std::string measured = File("measured_joints.txt", Matrix(3, 0.1)), sent = File("generated_joints.txt", Matrix(3, 0.0));
  for (const auto& files : {std::vector{measured, sent}, std::vector{sent, measured}}) {
    const Imported taken = TakeFiles(files);
    ASSERT_EQ(taken.readings.size(), 40u);
    EXPECT_NEAR(Mean_deg(taken), 0.1, 1e-3);
    EXPECT_THAT(taken.story, HasSubstr("row by row"));
  }
  EXPECT_NEAR(Mean_deg(TakeFiles({sent, measured}, "[course]\naxis_number = 3\n")), 0.3, 1e-3);
  EXPECT_NEAR(Mean_deg(TakeFiles({sent, measured}, "", {"reference_deg=[1:column 2]", "measured_deg=[2:column 2]"})), 0.2, 1e-3);
}

TEST_F(Importing, TakesAListBesideAListAndAListBesideATable) {
  std::string sent, came;
  for (int i = 0; i < 40; ++i) {
    sent += fmt::format("{}{}", i > 0 ? "," : "", 7 * i);
    came += fmt::format("{}{:.2f}", i > 0 ? "," : "", 7 * i + 0.25);
  }
  EXPECT_NEAR(Mean_deg(TakeFiles({File("a.csv", sent), File("b.csv", came)})), 0.25, 1e-9) << "the first is the reference";
  EXPECT_NEAR(Mean_deg(TakeFiles({File("position_actual.csv", came), File("position_set.csv", sent)})), 0.25, 1e-9);
  const std::vector<std::string> files = {File("protractor.txt", Matrix(1, 0.0)), File("joints.txt", Matrix(3, 0.1))};
  const std::string refusal = MessageOf([&] { TakeFiles(files); });
  EXPECT_THAT(refusal, HasSubstr("--column 'reference_deg=[entry]' --column 'measured_deg=[2:column 1]'"));
  EXPECT_NEAR(Mean_deg(TakeFiles(files, "", {"reference_deg=[entry]", "measured_deg=[2:column 1]"})), 0.1, 1e-3) << "as the message has it";
}

/// Both were written at the same instants, some of which are missing; a table of angles beside readings is no clock.
TEST_F(Importing, TakesTheColumnThatTwoFilesHaveInCommonForTheirClock) {
  std::string sent, came, table, again;
  for (int i = 0; i < 400; ++i) {
    const double t = 0.01 * i + (i > 200 ? 0.5 : 0.0);
    sent += fmt::format("{:.2f},{:.4f}\n", t, 10.0 * std::sin(t));
    came += fmt::format("{:.2f},{:.4f}\n", t, 10.0 * std::sin(t - 0.02));
  }
  const Imported taken = TakeFiles({File("u.txt", sent), File("y.txt", came)});
  EXPECT_THAT(taken.story, HasSubstr("motion that is read while it goes on"));
  EXPECT_EQ(taken.readings.size(), 400u);
  for (int i = 0; i < 36; ++i) {
    table += fmt::format("{},{:.2f}\n", 10 * i, 10 * i + 0.1);
    again += fmt::format("{},{:.2f}\n", 10 * i, 10 * i + 0.2);
  }
  EXPECT_EQ(TakeFiles({File("first.txt", table), File("second.txt", again)}).readings.back().setup, 1) << "two mountings";
}

/// A device that is 12 rows late, in lists: 100 a second until somebody says how often they were read.
TEST_F(Importing, TakesListsAtAStatedRateOrBesideTheirTimesForMotion) {
  std::string t = "t = [", sent = "set = [", came = "actual = [";
  for (int i = 0; i < 400; ++i) {
    t += fmt::format("{:.2f}, ", 0.02 * i);
    sent += fmt::format("{:.4f}, ", 10.0 * std::sin(0.1 * i));
    came += fmt::format("{:.4f}, ", 10.0 * std::sin(0.1 * (i - 12)));
  }
  const std::string lists = sent + "]\n" + came + "]\n";
  EXPECT_THAT(Take(lists).story, AllOf(HasSubstr("taken as motion"), HasSubstr("12 rows later: taken as motion that was read 100 times a second; --column 'rate_Hz=100'")));
  EXPECT_THAT(Take(lists, "[course]\nkind = \"stops\"\n").story, AllOf(HasSubstr("12 rows later"), Not(HasSubstr("taken as motion"))));
  EXPECT_THAT(Take(lists, "", {"rate_Hz=50"}).story, AllOf(HasSubstr("motion that is read while it goes on"), HasSubstr("50 Hz")));
  EXPECT_THAT(Take(t + "]\n" + lists).story, AllOf(HasSubstr("motion that is read while it goes on"), HasSubstr("50 Hz")));
  EXPECT_THAT(MessageOf([&] { Take(lists, "", {"rate_Hz=often"}); }), HasSubstr("a number above 0"));
}

/// One row late on a smooth profile is behind by its speed; behind by the same at any speed is play, which stops have too.
TEST_F(Importing, TakesRowsWithoutAClockForMotionWhereTheDeviceIsBehindByItsSpeed) {
  const auto table_of = [](double rows, double play) {
    std::string table = "set,actual\n";
    for (int i = 0; i < 400; ++i)
      table += fmt::format("{:.4f},{:.3f}\n", 10.0 * std::sin(0.1 * i), 10.0 * std::sin(0.1 * (i - rows)) - std::copysign(0.5 * play, std::cos(0.1 * i)));
    return table;
  };
  EXPECT_THAT(Take(table_of(0.8, 0.3)).story, AllOf(HasSubstr("by its speed, about 0.8 rows: taken as motion"), HasSubstr("while it goes on")));
  EXPECT_THAT(Take(table_of(0.0, 1.2)).story, HasSubstr("taken as stops"));
}

}  // namespace
}  // namespace twinbench::imports
