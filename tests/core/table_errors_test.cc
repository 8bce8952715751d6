#include "twin/core/table_errors.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/core/input_error.h"
#include "twin/core/units.h"

namespace twinbench {
namespace {

std::string FileError(const std::string& text) {
  const TemporaryFolder folder;
  const std::string path = folder.Write("t.csv", text);
  const std::string message = MessageOf([&] { ReadTableErrors(path); });
  return message.starts_with(path) ? message.substr(path.size()) : message;
}

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

TEST(TableErrors, NameLineAndFaultOfABadFile) {
  const std::string all = "position_deg,ex_arcsec,ey_arcsec,ez_arcsec,dx_um,dy_um,dz_um";
  EXPECT_EQ(FileError("ex_arcsec\n1\n"), ":1: the column position_deg is missing; expected " + all);
  EXPECT_EQ(FileError("#\nposition_deg,ex_urad\n1,2\n"), ":2: unknown column ex_urad; expected any of " + all);
  EXPECT_EQ(FileError("position_deg,dx_um\n1,2\n2,abc\n"), ":3: dx_um is \"abc\"; expected a finite number");
  EXPECT_EQ(FileError("position_deg,dx_um\n1,nan\n"), ":2: dx_um is \"nan\"; expected a finite number");
  EXPECT_EQ(FileError("position_deg,dx_um\n1,\n"), ":2: dx_um is \"\"; expected a finite number");
  EXPECT_EQ(FileError("position_deg,dx_um\n"), ":1: no rows follow the header; expected one row a position");
}

TEST(TableErrors, CannotBeWrittenWithColumnsOfUnequalLength) {
  TableErrors errors;
  errors.position_rad = {0.0};
  EXPECT_THROW(WriteTableErrors(errors, "unused.csv"), std::logic_error);
}

TEST(TableErrors, SayWhenTheDiskRefuses) {
  EXPECT_THROW(WriteTableErrors({}, "/no/such/folder/t.csv"), BenchError);
}

}  // namespace
}  // namespace twinbench
