#include <fmt/format.h>
#include <gmock/gmock.h>

#include "tests/import/importing.h"
#include "tests/support/kept_text.h"

/// Records in JSON, in the shapes in which programs write them.
namespace twinbench::imports {
namespace {

using testing::HasSubstr;

double Goal_rad(int i) {
  return 1.5 * std::sin(0.02 * i);
}

/// A servo that is where it was told 0.06 s ago, every 0.02 s.
std::string Record(int i) {
  return fmt::format(R"({{"position": {:.5f}, "goal_position": {:.5f}, "temp": 37.0, "on": true, "timestamp": {:.2f}}})", Goal_rad(i - 3),
                     Goal_rad(i), 0.02 * i);
}

void ExpectServo(const Imported& imported) {
  ASSERT_EQ(imported.readings.size(), 400u);
  const Reading& r = imported.readings.at(100);
  EXPECT_NEAR(ToSeconds(r.time), 2.0, 1e-9);
  EXPECT_NEAR(r.reference_rad, Goal_rad(100), 1e-5) << "programs count in rad";
  EXPECT_NEAR(r.measured_rad, Goal_rad(97), 1e-5);
  EXPECT_THAT(imported.story, HasSubstr("motion that is read while it goes on"));
}

TEST_F(Importing, ReadsAnObjectALineAndCountsALastOneThatWasCutOff) {
  std::string text;
  for (int i = 0; i < 400; ++i) text += Record(i) + "\n";
  ExpectServo(Take(text));
  EXPECT_THAT(Take(text).story, HasSubstr("its unit is not said and taken as rad"));
  const Imported cut = Take(text + R"({"position": 0.1, "goal_)");
  ExpectServo(cut);
  EXPECT_THAT(cut.story, HasSubstr("left out: 1 lines that are no object in JSON"));
}

TEST_F(Importing, ReadsAListOfObjectsWhereverItIs) {
  std::string list;
  for (int i = 0; i < 400; ++i) list += (i > 0 ? ",\n" : "") + Record(i);
  ExpectServo(Take("[" + list + "]"));
  ExpectServo(Take(R"({"kp": 32, "gains": [1, 2, 3], "log": {"entries": [)" + list + "]}}"));
}

/// One recording in a list of recordings, and the rate among the settings.
TEST_F(Importing, ReadsListsOfOneLengthInAListOfOne) {
  std::string goal, position;
  for (int i = 0; i < 400; ++i) {
    goal += fmt::format("{}{:.5f}", i > 0 ? ", " : "", Goal_rad(i));
    position += fmt::format("{}{:.5f}", i > 0 ? ", " : "", Goal_rad(i - 3));
  }
  ExpectServo(Take(R"({"config": {"control_hz": 50, "limits": [-1.6, 1.6]}, "data": [{"kind": "sine", "marks": [], "goal": [)" + goal +
                   R"(], "sensor_data": [)" + position + "]}]}"));
}

TEST_F(Importing, ReadsListsOfOneLength) {
  std::string goal, position, time, rows;
  for (int i = 0; i < 400; ++i) {
    const char* comma = i > 0 ? ", " : "";
    goal += fmt::format("{}{:.5f}", comma, Goal_rad(i));
    position += fmt::format("{}{:.5f}", comma, Goal_rad(i - 3));
    time += fmt::format("{}{:.2f}", comma, 0.02 * i);
    rows += fmt::format(", [{:.2f}, {:.5f}, {:.5f}]", 0.02 * i, Goal_rad(i), Goal_rad(i - 3));
  }
  ExpectServo(Take(fmt::format(R"({{"rate": 50, "goal": [{}], "position": [{}], "t": [{}]}})", goal, position, time)));
  ExpectServo(Take(R"([["t", "goal", "position"])" + rows + "]"));
}

TEST_F(Importing, NamesWhatStandsFurtherDownWithADot) {
  std::string text;
  for (int i = 0; i < 400; ++i)
    text += fmt::format(R"({{"t": {:.2f}, "command": {{"q": [{:.5f}]}}, "state": {{"q": [{:.5f}, 7], "dq": NaN}}}})", 0.02 * i, Goal_rad(i),
                        Goal_rad(i - 3)) + "\n";
  ExpectServo(Take(text, "[columns]\nreference_rad = \"command.q\"\nmeasured_rad = \"state.q.0\"\n"));
}

TEST_F(Importing, RefusesJsonWithoutRecords) {
  for (const char* text : {R"({"kp": 32, "ki": 1})", R"([{"a": 1}, {"a": 2)", R"([[1, 2, 3], [3, 4, 8], [5, 6, 9]])"})
    EXPECT_KEPT(MessageOf([&] { Take(text); }));
}

}  // namespace
}  // namespace twinbench::imports
