#include "twin/report/page/svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "twin/report/page/named_numbers.h"
#include "twin/report/page/svg_canvas.h"

namespace twinbench::report {
namespace {

constexpr double kWidth_px = 640.0, kHeight_px = 440.0, kPolarHeight_px = 600.0;
constexpr double kLeft_px = 76.0, kRight_px = 24.0, kTop_px = 72.0, kBottom_px = 56.0;
const Ink kGrid = {"#d9dcdf"};
const Ink kZero = {"#545c66", 1.0, "5 4"};

/// The colours of the page's light theme, the dashes likewise.
Ink InkOf(const FigureSeries& series, std::size_t k) {
  static const std::vector<std::string> colours = {"#0b62a8", "#b84a00", "#00735a", "#8a3f97", "#7a5b00", "#a8284b", "#3d5a80", "#5b6470"};
  static const std::vector<std::string> dashes = {"", "7 4", "2 3", "10 3 2 3", "4 2", "", "7 4", "2 3"};
  if (series.role == SeriesRole::kTruth) return {"#1c2126", 1.5, "2 4"};
  if (series.role == SeriesRole::kExpected) return {"#1c2126", 1.5, "8 4"};
  return {colours[k % colours.size()], 2.0, dashes[k % dashes.size()]};
}

bool IsOpen(const FigureSeries& series) {
  return series.role == SeriesRole::kTruth || series.role == SeriesRole::kBefore;
}

/// From the least to the largest of what was added.
struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  void Add(double value) {
    if (std::isfinite(value)) low = std::min(low, value), high = std::max(high, value);
  }
  bool IsEmpty() const { return low > high; }
};

double StepFor(double length, int parts) {
  const double power = std::pow(10.0, std::floor(std::log10(length / parts)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power * parts >= length) return factor * power;
  }
  return 10.0 * power;
}

/// An axis from whole step to whole step, on the way from one pixel to another.
struct Scale {
  double low = 0.0, high = 1.0, step = 0.2, from_px = 0.0, to_px = 1.0;
  double At(double value) const { return from_px + (value - low) / (high - low) * (to_px - from_px); }
};

Scale ScaleFor(Range range, double from_px, double to_px, bool in_whole_steps) {
  if (range.IsEmpty()) range = {0.0, 1.0};
  if (!(range.high > range.low)) range = {range.low - 0.5, range.high + 0.5};
  const double step = StepFor(range.high - range.low, 6);
  if (!in_whole_steps) return {range.low, range.high, step, from_px, to_px};
  return {std::floor(range.low / step) * step, std::ceil(range.high / step) * step, step, from_px, to_px};
}

std::vector<double> TicksOf(const Scale& scale) {
  std::vector<double> ticks;
  for (double k = std::ceil(scale.low / scale.step - 1e-9); k * scale.step <= scale.high + 1e-9 * scale.step; ++k) ticks.push_back(k * scale.step);
  return ticks;
}

std::string TickText(double value) {
  return fmt::format("{:.6g}", std::abs(value) < 1e-300 ? 0.0 : value);
}

std::string AxisText(const FigureAxis& axis) {
  return axis.unit.empty() ? axis.name : axis.name + " [" + ShownUnit(axis.unit) + "]";
}

void DrawHead(const Figure& figure, SvgCanvas& canvas) {
  const bool has_axis = figure.form != FigureForm::kAngle || figure.y.unit.empty();
  canvas.Text(20, 26, has_axis ? figure.title : figure.title + " [" + ShownUnit(figure.y.unit) + "]", "start", 15, true);
  double x = 20.0;
  for (std::size_t k = 0; k < figure.series.size(); ++k) {
    const FigureSeries& series = figure.series[k];
    canvas.Line(x, 46, x + 24, 46, InkOf(series, k));
    if (series.role != SeriesRole::kExpected) canvas.Dot(x + 12, 46, InkOf(series, k), IsOpen(series));
    const std::string text = series.name + (series.u.empty() ? "" : fmt::format(" (band: U, k = {:.2f})", series.k));
    canvas.Text(x + 30, 50, text);
    x += 54.0 + 6.6 * static_cast<double>(text.size());
  }
}

void DrawAxes(const Figure& figure, const Scale& x, const Scale& y, SvgCanvas& canvas) {
  for (const double tick : TicksOf(y)) {
    canvas.Line(x.from_px, y.At(tick), x.to_px, y.At(tick), kGrid);
    canvas.Text(x.from_px - 8, y.At(tick) + 4, TickText(tick), "end", 11);
  }
  for (const double tick : TicksOf(x)) canvas.Text(x.At(tick), y.from_px + 18, TickText(tick), "middle", 11);
  canvas.Line(x.from_px, y.from_px, x.to_px, y.from_px, {"#545c66"});
  canvas.Text((x.from_px + x.to_px) / 2, y.from_px + 42, AxisText(figure.x), "middle");
  canvas.Text(20, (y.from_px + y.to_px) / 2, AxisText(figure.y), "middle", 12, false, true);
}

Range RangeWithBands(const Figure& figure) {
  Range range;
  for (const FigureSeries& series : figure.series) {
    for (std::size_t k = 0; k < series.y.size(); ++k) {
      const double U = k < series.u.size() && std::isfinite(series.u[k]) ? series.k * series.u[k] : 0.0;
      range.Add(series.y[k] - U);
      range.Add(series.y[k] + U);
    }
  }
  return range;
}

Range RangeOfX(const Figure& figure) {
  Range range;
  for (const FigureSeries& series : figure.series) {
    for (const double x : series.x) range.Add(x);
  }
  return range;
}

/// @param at  Index of a point, value -> place [px].
template <class At>
void DrawSeries(const FigureSeries& series, const Ink& ink, bool joined, const At& at, SvgCanvas& canvas) {
  constexpr std::size_t kMostDots = 400;
  Corners upper, lower, middle;
  for (std::size_t k = 0; k < series.y.size(); ++k) {
    middle.push_back(at(k, series.y[k]));
    if (k >= series.u.size() || !std::isfinite(series.u[k]) || !std::isfinite(series.y[k])) continue;
    upper.push_back(at(k, series.y[k] + series.k * series.u[k]));
    lower.push_back(at(k, series.y[k] - series.k * series.u[k]));
  }
  if (upper.size() > 1) {
    upper.insert(upper.end(), lower.rbegin(), lower.rend());
    canvas.Area(upper, {ink.colour, 0.0, "", 0.2});
  }
  if (joined) canvas.Path(middle, ink);
  if (series.role == SeriesRole::kExpected || (joined && middle.size() > kMostDots)) return;
  for (const auto& [x, y] : middle) canvas.Dot(x, y, ink, IsOpen(series));
}

/// The shorter of two ranges is made longer about its middle until both have one scale.
void MakeEqual(Range& x, Range& y, double width_px, double height_px) {
  if (x.IsEmpty() || y.IsEmpty()) return;
  const double scale = std::max((x.high - x.low) / width_px, (y.high - y.low) / height_px);
  const auto about = [scale](Range& range, double length_px) {
    const double middle = (range.low + range.high) / 2;
    range = {middle - scale * length_px / 2, middle + scale * length_px / 2};
  };
  about(x, width_px);
  about(y, height_px);
}

std::string PlaneSvg(const Figure& figure) {
  SvgCanvas canvas(kWidth_px, kHeight_px);
  DrawHead(figure, canvas);
  const bool joined = figure.form == FigureForm::kLine || figure.form == FigureForm::kAngle;
  const bool equal = figure.form == FigureForm::kTrack;
  Range x_range = RangeOfX(figure), y_range = RangeWithBands(figure);
  y_range.Add(figure.y.low), y_range.Add(figure.y.high);
  if (equal) MakeEqual(x_range, y_range, kWidth_px - kRight_px - kLeft_px, kHeight_px - kBottom_px - kTop_px);
  const Scale x = ScaleFor(x_range, kLeft_px, kWidth_px - kRight_px, !joined && !equal);
  const Scale y = ScaleFor(y_range, kHeight_px - kBottom_px, kTop_px, !equal);
  DrawAxes(figure, x, y, canvas);
  for (std::size_t s = 0; s < figure.series.size(); ++s) {
    const FigureSeries& series = figure.series[s];
    DrawSeries(series, InkOf(series, s), joined, [&](std::size_t k, double value) { return std::pair(x.At(series.x[k]), y.At(value)); }, canvas);
  }
  return canvas.Text();
}

void DrawPolarGrid(const Figure& figure, const Scale& r, double middle_x, double middle_y, SvgCanvas& canvas) {
  for (const double tick : TicksOf(r)) {
    canvas.Circle(middle_x, middle_y, r.At(tick), std::abs(tick) < r.step / 2 ? kZero : kGrid);
  }
  for (int angle_deg = 0; angle_deg < 360; angle_deg += 30) {
    const double a = angle_deg * std::numbers::pi / 180.0;
    canvas.Line(middle_x, middle_y, middle_x + r.to_px * std::cos(a), middle_y - r.to_px * std::sin(a), kGrid);
    canvas.Text(middle_x + (r.to_px + 18) * std::cos(a), middle_y - (r.to_px + 18) * std::sin(a) + 4, fmt::format("{}°", angle_deg), "middle", 11);
  }
  for (const double tick : TicksOf(r)) canvas.Text(middle_x + r.At(tick), middle_y - 5, TickText(tick), "middle", 11);
  canvas.Text(20, kPolarHeight_px - 16, AxisText(figure.y) + ", outwards from the dashed circle");
}

/// A curve that goes all the way round ends where it began.
FigureSeries Closed(FigureSeries series) {
  if (series.x.size() < 3) return series;
  const double gap = std::abs(series.x[1] - series.x[0]);
  if (!(std::abs(std::abs(series.x.back() - series.x.front()) + gap - 360.0) < gap / 2)) return series;
  for (std::vector<double>* list : {&series.x, &series.y, &series.u}) {
    if (!list->empty()) list->push_back(list->front());
  }
  return series;
}

/// Zero is a circle half way out.
std::string PolarSvg(const Figure& figure) {
  const Range values = RangeWithBands(figure);
  const double size = values.IsEmpty() ? 1.0 : std::max({std::abs(values.low), std::abs(values.high), 1e-300});
  const double step = StepFor(size, 2);
  const double outer = std::ceil(size * 1.02 / step) * step;
  const Scale r = {-outer - step, outer, step, 0.0, 222.0};
  const double middle_x = kWidth_px / 2, middle_y = 322.0;
  SvgCanvas canvas(kWidth_px, kPolarHeight_px);
  DrawHead(figure, canvas);
  DrawPolarGrid(figure, r, middle_x, middle_y, canvas);
  for (std::size_t s = 0; s < figure.series.size(); ++s) {
    const FigureSeries series = Closed(figure.series[s]);
    const auto at = [&](std::size_t k, double value) {
      const double a = series.x[k] * std::numbers::pi / 180.0;
      return std::pair(middle_x + r.At(value) * std::cos(a), middle_y - r.At(value) * std::sin(a));
    };
    DrawSeries(series, InkOf(series, s), true, at, canvas);
  }
  return canvas.Text();
}

/// What noise or chance would do is a line over the bars.
bool IsBar(const FigureSeries& series) {
  return series.role != SeriesRole::kExpected;
}

std::string BarsSvg(const Figure& figure) {
  SvgCanvas canvas(kWidth_px, kHeight_px);
  DrawHead(figure, canvas);
  std::set<double> places;
  for (const FigureSeries& series : figure.series) places.insert(series.x.begin(), series.x.end());
  const double gap = places.size() > 1 ? (*places.rbegin() - *places.begin()) / static_cast<double>(places.size() - 1) : 1.0;
  Range x_range = RangeOfX(figure), y_range = RangeWithBands(figure);
  x_range.Add(x_range.low - 0.6 * gap), x_range.Add(x_range.high + 0.6 * gap), y_range.Add(0.0);
  const Scale x = ScaleFor(x_range, kLeft_px, kWidth_px - kRight_px, false);
  const Scale y = ScaleFor(y_range, kHeight_px - kBottom_px, kTop_px, true);
  DrawAxes(figure, x, y, canvas);
  const double group_px = 0.8 * gap / (x.high - x.low) * (x.to_px - x.from_px);
  const double bar_px = group_px / static_cast<double>(std::max<std::ptrdiff_t>(1, std::ranges::count_if(figure.series, IsBar)));
  for (std::size_t s = 0; s < figure.series.size(); ++s) {
    const FigureSeries& series = figure.series[s];
    if (!IsBar(series)) {
      DrawSeries(series, InkOf(series, s), true, [&](std::size_t k, double value) { return std::pair(x.At(series.x[k]), y.At(value)); }, canvas);
      continue;
    }
    for (std::size_t k = 0; k < series.x.size(); ++k) {
      if (!std::isfinite(series.y[k])) continue;
      const double top_px = std::min(y.At(series.y[k]), y.At(0.0));
      const double left_px = x.At(series.x[k]) - group_px / 2 + static_cast<double>(s) * bar_px;
      Ink ink = InkOf(series, s);
      ink.width_px = 1.0;
      canvas.Box(left_px, top_px, bar_px * 0.9, std::abs(y.At(series.y[k]) - y.At(0.0)), ink, IsOpen(series));
    }
  }
  return canvas.Text();
}

/// Lying bars, the series one behind the other.
std::string CategoriesSvg(const Figure& figure) {
  constexpr double kRow_px = 24.0, kNames_px = 250.0;
  const double bottom_px = kTop_px + kRow_px * static_cast<double>(figure.categories.size());
  SvgCanvas canvas(kWidth_px, bottom_px + kBottom_px);
  DrawHead(figure, canvas);
  Range range{0.0, 0.0};
  for (std::size_t c = 0; c < figure.categories.size(); ++c) {
    double sum = 0.0;
    for (const FigureSeries& series : figure.series) sum += std::isfinite(series.y[c]) ? series.y[c] : 0.0;
    range.Add(sum);
  }
  const Scale x = ScaleFor(range, kNames_px, kWidth_px - kRight_px, false);
  for (const double tick : TicksOf(x)) {
    canvas.Line(x.At(tick), kTop_px, x.At(tick), bottom_px, kGrid);
    canvas.Text(x.At(tick), bottom_px + 18, TickText(tick), "middle", 11);
  }
  canvas.Text((x.from_px + x.to_px) / 2, bottom_px + 42, AxisText(figure.y), "middle");
  for (std::size_t c = 0; c < figure.categories.size(); ++c) {
    const double top_px = kTop_px + kRow_px * static_cast<double>(c);
    canvas.Text(kNames_px - 8, top_px + 16, figure.categories[c].substr(0, 40), "end", 11);
    double begin = 0.0;
    for (std::size_t s = 0; s < figure.series.size(); ++s) {
      const double part = figure.series[s].y[c];
      if (!(part > 0.0)) continue;
      canvas.Box(x.At(begin), top_px + 5, x.At(begin + part) - x.At(begin), kRow_px - 10, InkOf(figure.series[s], s), false);
      begin += part;
    }
  }
  return canvas.Text();
}

std::string FileNameOf(const std::string& title) {
  std::string name;
  for (const char c : title) {
    if (std::isalnum(static_cast<unsigned char>(c))) {
      name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    } else if (!name.empty() && name.back() != '-') {
      name += '-';
    }
  }
  constexpr std::size_t kLongest = 80;
  name = name.substr(0, kLongest);
  return name.ends_with('-') ? name.substr(0, name.size() - 1) : name;
}

}  // namespace

std::string SvgOf(const Figure& figure) {
  switch (figure.form) {
    case FigureForm::kAngle: return PolarSvg(figure);
    case FigureForm::kBars:
    case FigureForm::kHistogram: return BarsSvg(figure);
    case FigureForm::kShares:
    case FigureForm::kRanks: return CategoriesSvg(figure);
    default: return PlaneSvg(figure);
  }
}

std::vector<std::pair<std::string, std::string>> SvgPictures(const Page& page) {
  std::vector<std::pair<std::string, std::string>> pictures;
  const auto add = [&pictures](const std::string& section, const Figure& figure) {
    pictures.emplace_back(FileNameOf(section + " " + (figure.file.empty() ? figure.title : figure.file)) + ".svg", SvgOf(figure));
  };
  for (const PageSection& section : page.sections) {
    for (const PageBlock& block : section.blocks) {
      if (const auto* figure = std::get_if<Figure>(&block)) add(section.title, *figure);
      if (const auto* choice = std::get_if<PageChoice>(&block); choice && !choice->figures.empty()) add(section.title, choice->figures.front());
    }
  }
  return pictures;
}

}  // namespace twinbench::report
