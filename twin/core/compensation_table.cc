#include "twin/core/compensation_table.h"

#include <algorithm>
#include <cmath>

#include "twin/core/csv.h"
#include "twin/core/errors.h"
#include "twin/core/number_text.h"
#include "twin/core/units.h"

namespace twinbench {
namespace {

constexpr double kTurn_rad = 2.0 * units::kPi;

std::vector<double> ColumnOfFile(const CsvTable& table, const std::string& name, double to_SI) {
  const std::size_t column = NeededColumn(table, name, std::string(kCompensationPosition) + "," + kCompensationCorrection);
  std::vector<double> values;
  for (const CsvTable::Row& row : table.rows) values.push_back(CsvNumber(table, row, column, to_SI));
  return values;
}

/// Between two entries, and how far along.
struct Piece {
  double left = 0.0, right = 0.0, share = 0.0, length_rad = kTurn_rad;
};

Piece PieceAt(const CompensationTable& table, double angle_rad) {
  const std::vector<double>& position_rad = table.position_rad;
  double within_rad = std::fmod(angle_rad, kTurn_rad);
  if (within_rad < 0.0) within_rad += kTurn_rad;
  // Entry `after` is the first behind the angle; the turn closes from the last entry to the first.
  const std::size_t n = position_rad.size();
  const auto after =
      static_cast<std::size_t>(std::ranges::upper_bound(position_rad, within_rad) - position_rad.begin());
  const std::size_t left = (after + n - 1) % n, right = after % n;
  const double from_rad = after == 0 ? position_rad[left] - kTurn_rad : position_rad[left];
  const double to_rad = after == n ? position_rad[right] + kTurn_rad : position_rad[right];
  return {table.correction_rad[left], table.correction_rad[right], (within_rad - from_rad) / (to_rad - from_rad),
          to_rad - from_rad};
}

}  // namespace

double CompensationTable::At(double angle_rad) const {
  const Piece piece = PieceAt(*this, angle_rad);
  return piece.left + piece.share * (piece.right - piece.left);
}

double CompensationTable::SlopeAt(double angle_rad) const {
  const Piece piece = PieceAt(*this, angle_rad);
  return (piece.right - piece.left) / piece.length_rad;
}

double CommandedAngle_rad(const std::optional<CompensationTable>& compensation, double angle_rad) {
  return compensation ? angle_rad + compensation->At(angle_rad) : angle_rad;
}

void RequireOneTurn(const CompensationTable& table, const std::string& where) {
  const std::vector<double>& at_rad = table.position_rad;
  const bool ascends = std::ranges::adjacent_find(at_rad, std::greater_equal<>()) == at_rad.end();
  if (!at_rad.empty() && ascends && at_rad.front() >= 0.0 && at_rad.back() < kTurn_rad) return;
  throw InputError(where, "the entries of the compensation are not the angles of one turn",
                   "position_deg that ascends from 0 to less than 360");
}

CompensationTable ReadCompensationTable(const std::string& path) {
  const CsvTable file = ReadCsv(path);
  const CompensationTable table{ColumnOfFile(file, kCompensationPosition, units::deg),
                                ColumnOfFile(file, kCompensationCorrection, units::arcsec)};
  RequireOneTurn(table, file.WhereHeader());
  return table;
}

std::string CompensationCsv(const CompensationTable& table, const std::vector<std::string>& comments) {
  std::string text;
  for (const std::string& comment : comments) text += "# " + comment + "\n";
  text += std::string(kCompensationPosition) + "," + kCompensationCorrection + "\n";
  for (std::size_t i = 0; i < table.position_rad.size(); ++i) {
    text += PrintInUnit(table.position_rad[i], units::deg) + "," +
            PrintInUnit(table.correction_rad[i], units::arcsec) + "\n";
  }
  return text;
}

}  // namespace twinbench
