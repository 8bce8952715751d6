#pragma once

#include <limits>
#include <vector>

#include "twin/core/bench_format.h"
#include "twin/import/blocks.h"
#include "twin/import/course.h"
#include "twin/import/import.h"
#include "twin/import/join.h"
#include "twin/import/one_to_one.h"

namespace twinbench::imports {

inline constexpr std::size_t kFewestCompared = 3;  // readings, or rests, that are worth a diagnosis where two quantities are compared

/// What is said of a whole run at the end.
struct Tally {
  std::vector<LeftOut> left_out;
  std::vector<std::string> remarks;
  std::vector<std::string> assumed;  // of sense and gear
  int wraps = 0, reversals = 0, rests = 0, fly_backs = 0;
  std::size_t rows = 0;
  double low = std::numeric_limits<double>::infinity(), high = -low, fastest = 0.0, rest_share = 0.0, widest = 0.0;
  bool stops = true;
  std::size_t usual_rows = 1;
};

/// Makes the readings of one set-up after the other.
class Maker {
 public:
  Maker(const BenchFormat& bench, const Map& map, bool linear) : bench_(bench), map_(map), linear_(linear) {}

  /// @param most  Readings: longer recordings are averaged in blocks.
  /// @throws InputError for a device that does not follow its reference, or that arrives nowhere.
  void Take(const Session& session, const MostReadings& most, Imported& imported);

  Tally tally;

 private:
  /// Where a reading stands in the course: which entry, at which angle.
  struct Place {
    std::size_t at = 0;
    double reference = 0.0;
  };
  Session Aligned(Session session, const Alignment& alignment);
  std::vector<std::size_t> Fresh(const Session& session, const Course& course) const;
  bool IsSentAnewEveryRow(const Session& session) const;
  bool IsProfile(const Session& session, const Course& course) const;
  std::vector<Rest> RestsIn(const Session& session, const Course& course) const;
  std::string CourseColumn(const Session& session) const;
  bool IsOnePlace(const Session& session) const;
  bool TakePushed(const Session& session, Course course, Imported& imported);
  void TakeAtUsualRate(Session session, const std::string& how_it_follows, const MostReadings& most, Imported& imported);
  void EndSetUp();
  void Count(const Session& session, const Course& course, const Blocks& cut);
  void TakeStops(const Session& session, const Course& course, const Blocks& cut, Imported& imported);
  Reading& Append(const Session& session, const Course& course, const Block& block, const Place& place, Imported& imported);
  void Fill(const std::string& name, const std::vector<double>& values, const Block& block, Reading& reading) const;
  double MeanAngle(const std::string& name, const std::vector<double>& values, const Block& block) const;

  const BenchFormat& bench_;
  const Map& map_;
  bool linear_, is_at_usual_rate_ = false;
  int setup_ = 0, first_pass_ = 0, last_pass_ = -1, position_ = 0;
};

/// Stops of the same angle get the same position, however often they were visited.
void NumberPositions(std::vector<Reading>& readings, const ReadingColumn& reference);

}  // namespace twinbench::imports
