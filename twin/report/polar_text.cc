#include "twin/report/polar_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/core/units.h"

namespace twinbench::report {
namespace {

constexpr int kRows = 33;        // a character is about twice as high as it is wide
constexpr double kCircle = 0.6;  // of the half side: where the value is zero
constexpr double kLargest = 0.4;

class Canvas {
 public:
  /// @param x, y  From -1 to 1, y up.
  void Put(double x, double y, char mark) {
    const int middle = kRows / 2;
    const int row = middle - static_cast<int>(std::lround(y * middle));
    const int column = 2 * middle + static_cast<int>(std::lround(x * 2 * middle));
    if (row < 0 || row >= kRows || column < 0 || column > 4 * middle) return;
    char& at = rows_[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)];
    const bool taken = at != ' ' && at != '.' && at != mark;
    at = taken ? '#' : mark;
  }

  std::string Text() const {
    std::string text;
    for (const std::string& row : rows_) text += row.substr(0, row.find_last_not_of(' ') + 1) + "\n";
    return text;
  }

 private:
  std::vector<std::string> rows_ = std::vector<std::string>(kRows, std::string(2 * kRows, ' '));
};

double LargestOf(const std::vector<PolarSeries>& series) {
  double largest = 0.0;
  for (const PolarSeries& s : series) {
    for (const double value : s.value) {
      if (std::isfinite(value)) largest = std::max(largest, std::abs(value));
    }
  }
  return largest;
}

void PutCircle(Canvas& canvas) {
  constexpr int kDots = 120;
  for (int k = 0; k < kDots; ++k) {
    const double angle_rad = units::turn * k / kDots;
    canvas.Put(kCircle * std::cos(angle_rad), kCircle * std::sin(angle_rad), '.');
  }
}

}  // namespace

std::string PolarText(const std::vector<PolarSeries>& series, const std::string& unit) {
  const double largest = LargestOf(series);
  if (largest == 0.0) return "";
  Canvas canvas;
  PutCircle(canvas);
  for (const PolarSeries& s : series) {
    for (std::size_t i = 0; i < s.value.size(); ++i) {
      if (!std::isfinite(s.value[i])) continue;
      const double r = kCircle + kLargest * s.value[i] / largest;
      canvas.Put(r * std::cos(s.angle_rad[i]), r * std::sin(s.angle_rad[i]), s.mark);
    }
  }
  return canvas.Text() + fmt::format("dots: zero; the edge: +{:.3g} {}\n", largest, unit);
}

}  // namespace twinbench::report
