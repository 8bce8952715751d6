#include <fmt/format.h>
#include <gmock/gmock.h>

#include "tests/import/importing.h"
#include "tests/support/kept_text.h"

/// The commonest test of backlash: one place, from both sides.
namespace twinbench::imports {
namespace {

using testing::HasSubstr;

void ExpectBothSides(const Imported& imported, int readings) {
  ASSERT_EQ(std::ssize(imported.readings), readings);
  for (int i = 0; i < readings; ++i) {
    const Reading& r = imported.readings[static_cast<std::size_t>(i)];
    EXPECT_EQ(r.direction, i % 2 == 0 ? 1 : -1);
    EXPECT_EQ(r.pass, i);
    EXPECT_EQ(r.position, 0);
    EXPECT_NEAR(r.measured_rad / units::deg, i % 2 == 0 ? -0.052 - 0.001 * (i / 2) : -0.040, 1e-9) << "a degree a millimetre";
  }
}

std::string OnePlace(const char* names, const char* up, const char* down, int pairs) {
  std::string text = std::string(names) + "\n";
  for (int i = 0; i < pairs; ++i) text += fmt::format("0;{:.3f};{}\n0;-0.040;{}\n", -0.052 - 0.001 * i, up, down);
  return text;
}

TEST_F(Importing, TakesOnePlaceFromBothSidesByItsDirections) {
  ExpectBothSides(Take(OnePlace("commanded [mm];dial [mm];direction", "1", "-1", 10)), 20);
  ExpectBothSides(Take(OnePlace("Soll [mm];Messuhr [mm];Richtung", "vorwärts", "rückwärts", 10)), 20);
  ExpectBothSides(Take(OnePlace("target [mm];gauge [mm];approach", "+", "-", 2)), 4);
}

TEST_F(Importing, TakesOnePlaceInTwoColumns) {
  std::string text = "# dial at 0 mm\nup [mm];down [mm]\n";
  for (int i = 0; i < 3; ++i) text += fmt::format("{:.3f};-0.040\n", -0.052 - 0.001 * i);
  ExpectBothSides(Take(text), 6);
}

TEST_F(Importing, SaysWhatAReferenceThatNeverMovesWouldNeed) {
  EXPECT_KEPT(MessageOf([&] { Take("commanded [mm];dial [mm]\n0;-0.052\n0;-0.040\n0;-0.063\n0;-0.045\n"); }));
  EXPECT_KEPT(MessageOf([&] { Take("commanded [mm];dial [mm];direction\n0;-0.052;1\n0;-0.040;1\n0;-0.063;1\n0;-0.045;1\n"); }));
  EXPECT_KEPT(MessageOf([&] { Take("commanded [mm];dial [mm];direction\n0;-0.052;1\n0;-0.040;-1\n"); }));
}

}  // namespace
}  // namespace twinbench::imports
