#include "twin/import/wrap_gaps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/core/units.h"
#include "twin/import/common.h"
#include "twin/import/whole_rows.h"

namespace twinbench::imports {
namespace {

constexpr double kFarLarger = 5.0;    // than the usual step
constexpr double kAboutATurn = 0.1;   // of a turn: what a gap may miss
constexpr std::size_t kNeighbours = 5;  // steps that say in which sense a column goes

/// Rows first and last have true values, those between them none.
struct Gap {
  std::size_t first = 0, last = 0;
};

/// From row to row; whole turns aside where `period` is positive.
std::vector<double> RowSteps(const std::vector<double>& x, double period) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < x.size(); ++i) steps.push_back(period > 0.0 ? std::remainder(x[i] - x[i - 1], period) : x[i] - x[i - 1]);
  return steps;
}

double UsualSize(const std::vector<double>& steps) {
  std::vector<double> sizes;
  for (const double step : steps) {
    if (step != 0.0) sizes.push_back(std::abs(step));
  }
  return MedianOf(std::move(sizes));
}

class GapFinder {
 public:
  GapFinder(const std::vector<double>& x, const std::vector<double>& other, double period)
      : period_(period), steps_(RowSteps(x, 0.0)), other_(RowSteps(other, period)), usual_(UsualSize(steps_)), usual_other_(UsualSize(other_)) {}

  std::vector<Gap> Find() const {
    std::vector<Gap> gaps;
    for (std::size_t i = 0; i < steps_.size();) {
      std::size_t end = i;
      while (end < steps_.size() && IsLarge(end) && steps_[end] * steps_[i] > 0.0) ++end;
      if (end > i + 1 && IsGap(i, end)) gaps.push_back({i, end});
      i = std::max(end, i + 1);
    }
    return gaps;
  }

 private:
  bool IsLarge(std::size_t i) const { return std::abs(steps_[i]) > kFarLarger * usual_; }

  /// Steps [begin, end): one turn back together, while the other column goes on.
  bool IsGap(std::size_t begin, std::size_t end) const {
    double sum = 0.0, other = 0.0;
    for (std::size_t i = begin; i < end; ++i) {
      if (std::abs(other_[i]) > kFarLarger * usual_other_) return false;
      sum += steps_[i];
      other += other_[i];
    }
    if (std::abs(std::abs(sum) - period_) > kAboutATurn * period_) return false;
    return SenseAround(steps_, begin, end) * sum < 0.0 && SenseAround(other_, begin, end) * other > 0.0;
  }

  /// Of the steps beside [begin, end), jumps aside: by its sign.
  double SenseAround(const std::vector<double>& steps, std::size_t begin, std::size_t end) const {
    double sum = 0.0;
    for (std::size_t i = begin - std::min(begin, kNeighbours); i < std::min(steps.size(), end + kNeighbours); ++i) {
      if ((i < begin || i >= end) && !IsLarge(i)) sum += steps[i];
    }
    return sum;
  }

  double period_;
  std::vector<double> steps_, other_;
  double usual_, usual_other_;
};

}  // namespace

Session WithoutWrapGaps(const Session& session, const std::vector<std::string>& columns, double period_rad,
                        std::vector<LeftOut>& left_out) {
  std::vector<bool> is_out(session.Rows(), false);
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const std::vector<double>& x = session.value.at(columns[k]);
    for (const Gap& gap : GapFinder(x, session.value.at(columns[1 - k]), period_rad).Find()) {
      std::fill(is_out.begin() + static_cast<std::ptrdiff_t>(gap.first) + 1, is_out.begin() + static_cast<std::ptrdiff_t>(gap.last), true);
      left_out.push_back({gap.last - gap.first - 1,
                          fmt::format("rows with {} between {:.6g} and {:.6g} deg, values between as of a table interpolated across the wrap",
                                      columns[k], x[gap.first] / units::deg, x[gap.last] / units::deg)});
    }
  }
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < is_out.size(); ++i) {
    if (!is_out[i]) kept.push_back(i);
  }
  return kept.size() == session.Rows() ? session : Chosen(session, kept);
}

}  // namespace twinbench::imports
