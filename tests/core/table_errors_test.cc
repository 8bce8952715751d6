#include "twin/core/table_errors.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/core/input_error.h"
#include "tests/core/refusals.h"
#include "twin/core/units.h"

namespace twinbench {
namespace {

TEST(TableErrors, HaveUnitsInTheirColumnsAndZerosForAbsentOnes) {
  const TemporaryFolder folder;
  const TableErrors errors =
      ReadTableErrors(folder.Write("t.csv", "# target\ndx_um,position_deg,ez_arcsec\n1.5,0,-2\n2.5,90,3\n"));
  EXPECT_EQ(errors.position_rad, (std::vector<double>{0.0, 90.0 * units::deg}));
  EXPECT_EQ(errors[Component::kDx], (std::vector<double>{1.5 * units::um, 2.5 * units::um}));
  EXPECT_EQ(errors[Component::kEz], (std::vector<double>{-2.0 * units::arcsec, 3.0 * units::arcsec}));
  EXPECT_EQ(errors[Component::kEy], (std::vector<double>{0.0, 0.0}));
}

TEST(TableErrors, AreReadBackToTheSameBits) {
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal;
  TableErrors errors;
  for (int i = 0; i < 100; ++i) {
    errors.position_rad.push_back(normal(random));
    for (auto& column : errors.value) column.push_back(1e-5 * normal(random));
  }
  const TemporaryFolder folder;
  WriteTableErrors(errors, folder.File("t.csv"));
  const TableErrors read = ReadTableErrors(folder.File("t.csv"));
  EXPECT_EQ(read.position_rad, errors.position_rad);
  EXPECT_EQ(read.value, errors.value);
}

TEST(TableErrors, NameLineAndFaultOfABadFileAndAreNotWrittenWithColumnsOfUnequalLengthOrWhereTheDiskRefuses) {
  const TemporaryFolder folder;
  ExpectRefused(folder.File("t.csv"),
                [&](const auto& text) { return MessageOf([&] { ReadTableErrors(folder.Write("t.csv", text)); }); },
                {{1, "ex_arcsec\n1\n"}, {2, "#\nposition_deg,ex_urad\n1,2\n"},
                 {3, "position_deg,dx_um\n1,2\n2,abc\n"}, {2, "position_deg,dx_um\n1,nan\n"},
                 {2, "position_deg,dx_um\n1,\n"}, {1, "position_deg,dx_um\n"}});
  TableErrors errors;
  EXPECT_THROW(WriteTableErrors(errors, "/no/such/folder/t.csv"), BenchError);
  errors.position_rad = {0.0};
  EXPECT_THROW(WriteTableErrors(errors, "unused.csv"), std::logic_error);
}

}  // namespace
}  // namespace twinbench
