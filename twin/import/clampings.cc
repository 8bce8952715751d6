#include "twin/import/clampings.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "twin/core/errors.h"
#include "twin/core/linear_algebra.h"
#include "twin/import/column_words.h"
#include "twin/import/common.h"

namespace twinbench::imports {
namespace {

constexpr double kCircle_deg = 360.0;
constexpr double kOffGrid = 0.02;           // of a step: what writing angles down may have cost
constexpr double kWrittenTo_arcsec = 1e-4;  // no file has more digits
constexpr double kClearLead = 7.0;          // of the logarithm of likelihoods
constexpr double kLeastDof = 4.0;
constexpr int kMostTried = 40;  // faces up to which every number of steps is tried

const Column* FindColumn(const Track& track, std::string_view name) {
  const auto found = std::ranges::find(track.columns, name, &Column::name);
  return found == track.columns.end() ? nullptr : &*found;
}

std::vector<double> ValuesOr(const Track& track, std::string_view name, double otherwise) {
  const Column* column = FindColumn(track, name);
  return column ? column->value : std::vector<double>(track.Rows(), otherwise);
}

/// Labels from 0 in the order of their first row.
std::vector<int> Numbered(const std::vector<std::vector<double>>& by) {
  std::map<std::vector<double>, int> known;
  std::vector<int> numbers;
  for (std::size_t row = 0; row < by.front().size(); ++row) {
    std::vector<double> label;
    for (const std::vector<double>& values : by) label.push_back(std::isfinite(values[row]) ? values[row] : -1.0);
    numbers.push_back(known.emplace(label, std::ssize(known)).first->second);
  }
  return numbers;
}

/// Rows that stand clamping beside clamping are taken apart; a clock would be torn.
void SortByClamping(Track& track) {
  if (track.HasClock()) return;
  const std::vector<int> clamping =
      Numbered({ValuesOr(track, "clamping", 0.0), ValuesOr(track, "offset_deg", 0.0)});
  if (std::ranges::is_sorted(clamping)) return;
  std::vector<std::size_t> order(clamping.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&clamping](std::size_t row) { return clamping[row]; });
  for (Column& column : track.columns) {
    std::vector<double> sorted;
    for (const std::size_t row : order) sorted.push_back(column.value[row]);
    column.value = std::move(sorted);
  }
}

/// What the rows of a face table say of clampings.
struct FaceRows {
  int faces = 0;
  std::vector<int> place;                  // nominal angle in steps, within a turn
  std::vector<int> clamping, group;        // group: clamping, run and direction, which have a constant each
  std::vector<double> value_arcsec;        // less what is certified
  std::vector<double> number, turned_deg;  // by clamping; NaN: not said

  double Step_deg() const { return kCircle_deg / faces; }
  int Clampings() const { return static_cast<int>(number.size()); }
};

int WithinTurn(long turned, int faces) {
  return static_cast<int>(((turned % faces) + faces) % faces);
}

FaceRows RowsOf(const Track& track) {
  FaceRows rows;
  rows.faces = static_cast<int>(std::lround(FindColumn(track, "faces")->value.front()));
  const std::vector<double> number = ValuesOr(track, "clamping", 0.0), turned = ValuesOr(track, "offset_deg", kNaN);
  rows.clamping = Numbered({number, turned});
  rows.group = Numbered({number, turned, ValuesOr(track, "run", 0.0), ValuesOr(track, "direction", 0.0)});
  const std::vector<double>&nominal = FindColumn(track, "nominal_deg")->value,
        &reading = FindColumn(track, "reading_arcsec")->value;
  const std::vector<double> certified = ValuesOr(track, "certified_arcsec", 0.0);
  const bool is_number_said_as_angle = turned == number;  // "clamping 30", read twice
  for (std::size_t i = 0; i < nominal.size(); ++i) {
    rows.place.push_back(
        std::isfinite(nominal[i]) ? WithinTurn(std::lround(nominal[i] / rows.Step_deg()), rows.faces) : 0);
    rows.value_arcsec.push_back(reading[i] - certified[i]);
    if (rows.clamping[i] < rows.Clampings()) continue;
    rows.number.push_back(number[i]);
    rows.turned_deg.push_back(is_number_said_as_angle ? kNaN : turned[i]);
  }
  return rows;
}

/// Whether a column has the same at a nominal angle in every clamping.
bool IsOfThePlace(const std::vector<double>& values, const FaceRows& rows) {
  std::map<int, double> at;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i]) && std::abs(at.emplace(rows.place[i], values[i]).first->second - values[i]) > 1e-9)
      return false;
  }
  return true;
}

/// By clamping, how many steps lie from what the rows are, places of the table or faces, to the other that was met
/// there.
using StepsBetween = std::vector<int>;

/// What is left of the readings if the polygon was turned so.
struct Left {
  double squares_arcsec2 = kNaN, dof = 0.0;
  double Variance() const { return squares_arcsec2 / dof + kWrittenTo_arcsec * kWrittenTo_arcsec; }
  double Rms_arcsec() const { return std::sqrt(Variance()); }
};

/// Of table + face + a constant a group, by least squares.
Left LeftBy(const StepsBetween& turns, const FaceRows& rows) {
  const int n = rows.faces, groups = 1 + std::ranges::max(rows.group);
  Eigen::MatrixXd squares = Eigen::MatrixXd::Zero(2 * n + groups, 2 * n + groups);
  Eigen::VectorXd products = Eigen::VectorXd::Zero(2 * n + groups);
  double all = 0.0, count = 0.0;
  std::vector<double> known;
  std::ranges::copy_if(rows.value_arcsec, std::back_inserter(known), [](double x) { return std::isfinite(x); });
  const double middle = MedianOf(known);
  for (std::size_t i = 0; i < rows.place.size(); ++i) {
    const double value = rows.value_arcsec[i] - middle;
    if (!std::isfinite(value)) continue;
    const int at[] = {rows.place[i],
                      n + WithinTurn(rows.place[i] + turns[static_cast<std::size_t>(rows.clamping[i])], n),
                      2 * n + rows.group[i]};
    for (const int a : at) {
      for (const int b : at) squares(a, b) += 1.0;
      products[a] += value;
    }
    all += value * value;
    count += 1.0;
  }
  const RankedSolution solution = SolveRanked(squares, products, 1e-9);
  return {std::max(0.0, all - solution.x.col(0).dot(products)), count - static_cast<double>(solution.rank)};
}

/// Whether one is so much worse than another that chance does not explain it.
bool IsClearlyWorse(const Left& one, const Left& than) {
  const double dof = std::min(one.dof, than.dof);
  return dof >= kLeastDof && 0.5 * dof * std::log(one.Variance() / than.Variance()) > kClearLead;
}

std::optional<StepsBetween> WholeSteps(const std::vector<double>& turned_deg, const FaceRows& rows, double sense) {
  StepsBetween turns;
  for (const double turned : turned_deg) {
    const double steps = sense * (std::isfinite(turned) ? turned : 0.0) / rows.Step_deg();
    if (std::abs(steps - std::round(steps)) > kOffGrid) return std::nullopt;
    turns.push_back(WithinTurn(std::lround(steps), rows.faces));
  }
  return turns;
}

bool AreAllOne(const StepsBetween& turns) {
  return std::ranges::all_of(turns, [&turns](int t) { return t == turns.front(); });
}

void AddOther(const std::optional<StepsBetween>& turns, std::vector<StepsBetween>& to) {
  if (turns && !AreAllOne(*turns) && std::ranges::find(to, *turns) == to.end()) to.push_back(*turns);
}

/// In both senses, the nominal angles' first: a polygon that was turned on shows a face earlier.
std::vector<StepsBetween> SaidTurns(const FaceRows& rows, double sense) {
  std::vector<StepsBetween> tried;
  for (const double way : {sense, -sense}) AddOther(WholeSteps(rows.turned_deg, rows, way), tried);
  return tried;
}

/// From there on one clamping after the other is turned to where it leaves least, until none does any better.
StepsBetween Settled(StepsBetween turns, const FaceRows& rows) {
  double least = LeftBy(turns, rows).squares_arcsec2;
  for (bool is_better = true; is_better;) {
    is_better = false;
    for (std::size_t k = 1; k < turns.size(); ++k) {
      for (int turned = 0; turned < rows.faces; ++turned) {
        StepsBetween other = turns;
        other[k] = turned;
        const double left = LeftBy(other, rows).squares_arcsec2;
        if (!(left < least - kWrittenTo_arcsec * kWrittenTo_arcsec)) continue;
        least = left;
        turns = std::move(other);
        is_better = true;
      }
    }
  }
  return turns;
}

/// Where clampings are turned by other steps each time: from those with equal steps that leave least, as many as take no time.
void AddSettled(const FaceRows& rows, std::vector<StepsBetween>& tried) {
  constexpr int kFewestClampings = 3;  // two fit any turn
  const auto most = static_cast<std::size_t>(std::max(3, 150 / rows.faces));
  if (rows.Clampings() < kFewestClampings || rows.faces > kMostTried) return;
  std::vector<std::pair<double, StepsBetween>> begins;
  for (const StepsBetween& turns : tried) begins.emplace_back(LeftBy(turns, rows).squares_arcsec2, turns);
  std::ranges::stable_sort(begins, {}, &std::pair<double, StepsBetween>::first);
  if (begins.size() > most) begins.resize(most);
  for (const auto& [left, begin] : begins) AddOther(Settled(begin, rows), tried);
}

/// Clampings that are only numbered: as degrees where these are whole steps, else some steps from one to the next.
std::vector<StepsBetween> NumberedTurns(const FaceRows& rows) {
  std::vector<StepsBetween> tried;
  for (const double sense : {1.0, -1.0}) AddOther(WholeSteps(rows.number, rows, sense), tried);
  const int most = rows.faces <= kMostTried ? rows.faces / 2 : 1;
  for (int q = 1; q <= most; ++q) {
    for (const double sense : {1.0, -1.0}) {
      std::vector<double> turned_deg;
      for (const double number : rows.number)
        turned_deg.push_back((number - rows.number.front()) * q * rows.Step_deg());
      AddOther(WholeSteps(turned_deg, rows, sense), tried);
    }
  }
  AddSettled(rows, tried);
  return tried;
}

std::string InDegrees(const StepsBetween& turns, double sense, const FaceRows& rows) {
  std::string text;
  for (const int t : turns)
    text += fmt::format("{}{:.6g}", text.empty() ? "" : ", ",
                        WithinTurn(static_cast<long>(sense) * t, rows.faces) * rows.Step_deg());
  return text + " deg";
}

/// The turns that leave least, and what is said of them.
struct ChosenSteps {
  StepsBetween turns;
  std::string said;
};

ChosenSteps BestOf(const std::vector<StepsBetween>& tried, bool is_said, double sense, const FaceRows& rows) {
  std::vector<Left> left;
  for (const StepsBetween& turns : tried) left.push_back(LeftBy(turns, rows));
  std::size_t best = 0;
  for (std::size_t k = 1; k < tried.size(); ++k) {
    if (IsClearlyWorse(left[best], left[k])) best = k;
  }
  const StepsBetween none(tried.front().size(), 0);
  const bool is_clear = std::ranges::all_of(
      left, [&](const Left& other) { return &other == &left[best] || IsClearlyWorse(other, left[best]); });
  if (!is_said && !(is_clear && IsClearlyWorse(LeftBy(none, rows), left[best])))
    return {none, fmt::format("by how much the polygon was turned between its {} clampings is not said, and the "
                              "readings do not show it: it is taken as not "
                              "turned; --column 'offset_deg=30 * clamping' says so",
                              rows.Clampings())};
  const std::string turned = fmt::format("the polygon was turned by {} in the sense of the nominal angles",
                                         InDegrees(tried[best], sense, rows));
  if (is_clear && tried.size() > 1)
    return {tried[best],
            fmt::format("{}: what the readings fit, to {:.3g} arcsec", turned, left[best].Rms_arcsec())};
  if (tried.size() == 1) return {tried[best], turned};
  return {tried[best],
          turned +
              ": the sense is assumed, these readings fit the other one as well, which has other errors; "
              "--column 'offset_deg=-offset' says the other"};
}

/// The table's angle or the face's stands in the rows.
bool AreRowsFaces(const Track& track, const FaceRows& rows) {
  const Column* face = FindColumn(track, "face");
  if (face && !face->value.empty()) return true;  // the same in all clampings: else it was taken as it is
  const std::vector<double> certified = ValuesOr(track, "certified_arcsec", 0.0);
  const bool is_certified =
      std::ranges::any_of(certified, [&](double x) { return std::isfinite(x) && x != certified.front(); });
  if (is_certified && IsOfThePlace(certified, rows)) return true;
  const std::vector<double>& nominal = FindColumn(track, "nominal_deg")->value;
  return std::ranges::any_of(track.columns, [&nominal](const Column& c) {
    return c.value == nominal && ClearnessBy(c.name, {"face", "polygon", "facet", "fläche", "facette"}) > 0 &&
           ClearnessBy(c.name, {"table", "tisch", "turntable"}) == 0;
  });
}

/// +1 where the numbers of the faces rise with the nominal angle, -1 where they fall.
double SenseOfFaces(const std::vector<double>& face, const FaceRows& rows) {
  int up = 0, down = 0;
  for (std::size_t i = 1; i < face.size(); ++i) {
    if (rows.clamping[i] != rows.clamping[i - 1] || rows.group[i] != rows.group[i - 1]) continue;
    const int by = WithinTurn(std::lround(face[i] - face[i - 1]), rows.faces),
              way = WithinTurn(rows.place[i] - rows.place[i - 1], rows.faces);
    up += by == way ? 1 : 0;
    down += WithinTurn(by + way, rows.faces) == 0 ? 1 : 0;
  }
  return up >= down ? 1.0 : -1.0;
}

void PutColumns(std::vector<double> table_deg, std::vector<double> face_deg, const FaceRows& rows, Track& track) {
  std::erase_if(track.columns, [](const Column& c) { return c.name == "clamping"; });
  const auto put = [&track](const char* name, const char* unit, std::vector<double> values) {
    for (Column& own : track.columns) own.name += own.name == name ? " of the file" : "";
    track.columns.push_back({name, unit, std::move(values), {}});
  };
  put("clamping", "", {rows.clamping.begin(), rows.clamping.end()});
  put("table_deg", "deg", std::move(table_deg));
  put("face_deg", "deg", std::move(face_deg));
}

[[noreturn]] void RefuseOffset(const FaceRows& rows, const std::string& file) {
  double off_deg = 0.0;
  for (const double turned : rows.turned_deg) {
    if (std::abs(std::remainder(turned, rows.Step_deg())) > kOffGrid * rows.Step_deg()) off_deg = turned;
  }
  throw InputError(
      file,
      fmt::format("the polygon was turned by {:.6g} deg, which is no whole number of its {} steps of {:.6g} deg",
                  off_deg, rows.faces, rows.Step_deg()),
      "clampings that are whole steps apart; others one by one");
}

}  // namespace

void PlaceClampings(const Map& map, Recording& recording, Track& track) {
  if (!SeeksClampings(map)) return;
  SortByClamping(track);
  const FaceRows rows = RowsOf(track);
  const std::vector<double> nominal = FindColumn(track, "nominal_deg")->value;
  if (rows.Clampings() < 2) return PutColumns(nominal, nominal, rows, track);
  const Column* face = FindColumn(track, "face");
  if (face && !IsOfThePlace(face->value, rows)) {
    std::vector<double> face_deg = face->value;
    const double step_deg = rows.Step_deg() * SenseOfFaces(face_deg, rows);
    const double first = std::ranges::min(face_deg);
    for (double& x : face_deg) x = (x - first) * step_deg;
    return PutColumns(nominal, std::move(face_deg), rows, track);
  }
  const bool is_said = std::ranges::any_of(rows.turned_deg, [](double x) { return std::isfinite(x); }),
             are_faces = AreRowsFaces(track, rows);
  const double sense = are_faces ? -1.0 : 1.0;
  const std::vector<StepsBetween> tried = is_said ? SaidTurns(rows, sense) : NumberedTurns(rows);
  if (is_said && !WholeSteps(rows.turned_deg, rows, 1.0)) RefuseOffset(rows, recording.file);
  if (tried.empty()) return PutColumns(nominal, nominal, rows, track);
  const ChosenSteps best = BestOf(tried, is_said, sense, rows);
  std::vector<double> other = nominal;
  for (std::size_t i = 0; i < other.size(); ++i)
    other[i] += best.turns[static_cast<std::size_t>(rows.clamping[i])] * rows.Step_deg();
  const char* of = AreAllOne(best.turns) ? ""
                   : are_faces           ? "; the nominal angles are the faces'"
                                         : "; the nominal angles are the table's";
  recording.remarks.push_back(best.said + of);
  are_faces ? PutColumns(std::move(other), nominal, rows, track)
            : PutColumns(nominal, std::move(other), rows, track);
}

}  // namespace twinbench::imports
