#include "twin/import/whole_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace twinbench::imports {
namespace {

class Rows {
 public:
  Rows(const Session& session, const BenchFormat& bench, const Map& map) : session_(session), bench_(bench), map_(map) {}

  Session Whole(std::vector<LeftOut>& left_out) const {
    std::vector<std::size_t> kept;
    std::size_t without = 0, unwanted = 0, back = 0;
    double last_s = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < session_.Rows(); ++i) {
      if (!HasAll(i, true)) {
        ++(HasAll(i, false) ? unwanted : without);
      } else if (!(session_.time_s[i] > last_s || (session_.time_s[i] == last_s && !session_.has_clock))) {
        ++back;
      } else {
        kept.push_back(i);
        last_s = session_.time_s[i];
      }
    }
    if (unwanted > 0) left_out.push_back({unwanted, map_.leaves_out});
    if (without > 0) left_out.push_back({without, "rows without a time or a value that is needed"});
    if (back > 0) left_out.push_back({back, "rows whose time does not go on"});
    return Chosen(session_, kept);
  }

 private:
  /// @param wanted  Also what the map has no value of on purpose.
  bool HasAll(std::size_t i, bool wanted) const {
    if (!std::isfinite(session_.time_s[i])) return false;
    return std::ranges::all_of(session_.value, [&](const auto& entry) {
      const ReadingColumn* column = ColumnOf(bench_, entry.first);
      return !column || !column->MustBeThere() || std::isfinite(entry.second[i]) || (!wanted && LeavesOut(entry.first));
    });
  }

  bool LeavesOut(const std::string& name) const {
    const auto mapped = std::ranges::find(map_.columns, name, &MappedColumn::column);
    return !map_.leaves_out.empty() && mapped != map_.columns.end() && mapped->expression.find("only(") != std::string::npos;
  }

  const Session& session_;
  const BenchFormat& bench_;
  const Map& map_;
};

}  // namespace

const ReadingColumn* ColumnOf(const BenchFormat& bench, const std::string& name) {
  const auto found = std::ranges::find(bench.columns, name, &ReadingColumn::name);
  return found == bench.columns.end() ? nullptr : &*found;
}

Session Chosen(const Session& session, const std::vector<std::size_t>& rows) {
  Session chosen{session.name, session.has_clock, {}, {}};
  for (const std::size_t i : rows) chosen.time_s.push_back(session.time_s[i]);
  for (const auto& [name, values] : session.value) {
    for (const std::size_t i : rows) chosen.value[name].push_back(values[i]);
  }
  return chosen;
}

Session WholeRows(const Session& session, const BenchFormat& bench, const Map& map, std::vector<LeftOut>& left_out) {
  return Rows(session, bench, map).Whole(left_out);
}

}  // namespace twinbench::imports
