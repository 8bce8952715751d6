#include "twin/diagnose/as_predicted.h"

#include <algorithm>
#include <iterator>

namespace twinbench::diagnose {

std::vector<ReadingColumn> ShownColumns(const TwinComparison& comparison) {
  std::vector<ReadingColumn> columns;
  std::ranges::copy_if(comparison.format->columns, std::back_inserter(columns),
                       [](const ReadingColumn& c) { return c.role == ColumnRole::kShown; });
  return columns;
}

std::vector<Reading> AsPredicted(const Compared& compared, const TwinComparison& comparison) {
  std::vector<Reading> readings = compared.used;
  if (comparison.show) {
    const Eigen::Index channels = compared.run.Channels();
    for (std::size_t i = 0; i < readings.size(); ++i)
      comparison.show(readings[i], compared.predicted.segment(static_cast<Eigen::Index>(i) * channels, channels));
    return readings;
  }
  if (comparison.shown) return readings;  // of values that are no columns
  const std::vector<ReadingColumn> columns = ShownColumns(comparison);
  Eigen::Index row = 0;
  for (Reading& reading : readings) {
    for (const ReadingColumn& column : columns) column.number(reading) = compared.predicted[row++];
  }
  return readings;
}

std::vector<Reading> RecordAsPredicted(const Compared& c, std::vector<Reading> readings,
                                       const TwinComparison& comparison) {
  if (!comparison.show) return readings;
  const std::vector<Reading> predicted = AsPredicted(c, comparison);
  std::size_t next = 0;
  for (Reading& r : readings) {
    if (next < predicted.size() && r.reading == predicted[next].reading) r = predicted[next++];
  }
  return readings;
}

}  // namespace twinbench::diagnose
