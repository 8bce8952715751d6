#include "twin/report/curve_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "twin/report/text_table.h"

namespace twinbench::report {
namespace {

constexpr int kColumns = 68, kPlotRows = 15;
constexpr int kDotsAcross = 2, kDotsDown = 4;  // of a Braille character
constexpr std::size_t kLabel = 10;             // letters before the frame

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();

  void Add(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  bool IsEmpty() const { return !(low <= high); }
  double At(double share) const { return low + share * (high - low); }
  /// Of `steps` equal ones, the one where `value` lies.
  int Step(double value, int steps) const {
    return static_cast<int>(std::lround((value - low) / (high - low) * (steps - 1)));
  }
  /// Three digits of the range.
  std::string Label(double value) const {
    const double digits = 2.0 - std::floor(std::log10(high - low));
    if (digits > 6.0 || std::max(std::abs(low), std::abs(high)) >= 1e6) return fmt::format("{:.3g}", value);
    const int decimals = std::max(0, static_cast<int>(digits));
    const bool is_zero = std::abs(value) < 0.5 * std::pow(10.0, -decimals);
    return fmt::format("{:.{}f}", is_zero ? 0.0 : value, decimals);
  }
};

struct Dot {
  int x, y;  // from the upper left corner
};

/// One character of the plot.
struct PlotCell {
  unsigned braille = 0;
  bool forward = false, backward = false;
};

class Plot {
 public:
  explicit Plot(const CurveText& curve) {
    for (std::size_t k = 0; k < curve.x.size(); ++k) {
      const double back = k < curve.backward.size() ? curve.backward[k] : std::nan("");
      if (!std::isfinite(curve.forward[k]) && !std::isfinite(back)) continue;
      x_.Add(curve.x[k]);
      y_.Add(curve.forward[k]);
      y_.Add(back);
    }
    if (y_.low == y_.high) y_ = {y_.low - 0.5, y_.high + 0.5};  // a level line, in the middle
  }

  bool IsEmpty() const { return x_.IsEmpty() || x_.low == x_.high; }
  const Range& x() const { return x_; }
  const Range& y() const { return y_; }

  void PutForward(const CurveText& curve) {
    const Dot* before = nullptr;
    Dot last{};
    for (std::size_t k = 0; k < curve.x.size(); ++k) {
      if (!std::isfinite(curve.forward[k])) {
        before = nullptr;
        continue;
      }
      const Dot dot = DotAt(curve.x[k], curve.forward[k]);
      CellAt(dot).forward = true;
      PutLine(before ? *before : dot, dot);
      last = dot;
      before = &last;
    }
  }

  void PutBackward(const CurveText& curve) {
    for (std::size_t k = 0; k < curve.backward.size(); ++k) {
      if (std::isfinite(curve.backward[k])) CellAt(DotAt(curve.x[k], curve.backward[k])).backward = true;
    }
  }

  std::string Row(int row, Letters letters) const {
    const bool has_zero = y_.low < 0.0 && y_.high > 0.0 && RowOfZero() == row;
    std::string text;
    for (const PlotCell& cell : cells_[static_cast<std::size_t>(row)])
      text += letters == Letters::kAscii ? Ascii(cell, has_zero) : Unicode(cell, has_zero);
    return text;
  }

 private:
  Dot DotAt(double x, double y) const {
    const int down = kDotsDown * kPlotRows;
    return {x_.Step(x, kDotsAcross * kColumns), down - 1 - y_.Step(y, down)};
  }
  int RowOfZero() const { return DotAt(x_.low, 0.0).y / kDotsDown; }

  PlotCell& CellAt(Dot dot) {
    return cells_[static_cast<std::size_t>(dot.y / kDotsDown)][static_cast<std::size_t>(dot.x / kDotsAcross)];
  }

  void PutLine(Dot from, Dot to) {
    // Bits of the dots of a Braille character (Unicode, block 2800), by column and row.
    constexpr std::array<std::array<unsigned, kDotsDown>, kDotsAcross> kBits = {
        {{0x01, 0x02, 0x04, 0x40}, {0x08, 0x10, 0x20, 0x80}}};
    const int steps = std::max({1, std::abs(to.x - from.x), std::abs(to.y - from.y)});
    for (int k = 0; k <= steps; ++k) {
      const double share = static_cast<double>(k) / steps;
      const Dot dot{static_cast<int>(std::lround(from.x + share * (to.x - from.x))),
                    static_cast<int>(std::lround(from.y + share * (to.y - from.y)))};
      CellAt(dot).braille |=
          kBits[static_cast<std::size_t>(dot.x % kDotsAcross)][static_cast<std::size_t>(dot.y % kDotsDown)];
    }
  }

  static std::string Ascii(const PlotCell& cell, bool on_zero) {
    if (cell.forward && cell.backward) return "x";
    if (cell.forward) return ">";
    if (cell.backward) return "<";
    return on_zero ? "." : " ";
  }

  static std::string Unicode(const PlotCell& cell, bool on_zero) {
    if (cell.backward) return cell.braille != 0 ? "●" : "○";
    if (cell.braille == 0) return on_zero ? "·" : " ";
    return {static_cast<char>(0xE2), static_cast<char>(0xA0U | (cell.braille >> 6U)),
            static_cast<char>(0x80U | (cell.braille & 0x3FU))};
  }

  Range x_, y_;
  std::array<std::array<PlotCell, kColumns>, kPlotRows> cells_;
};

/// Both ends and the middle.
std::string LabelOfRow(const Plot& plot, int row) {
  constexpr int kMiddle = kPlotRows / 2;
  if (row != 0 && row != kMiddle && row != kPlotRows - 1) return "";
  return plot.y().Label(plot.y().At(1.0 - static_cast<double>(row) / (kPlotRows - 1)));
}

std::string AxisLine(const Plot& plot, const std::string& name) {
  const std::string low = plot.x().Label(plot.x().low), middle = plot.x().Label(plot.x().At(0.5)),
                    high = plot.x().Label(plot.x().high);
  std::string line(kLabel + 1 + kColumns, ' ');
  line.replace(kLabel + 1, low.size(), low);
  line.replace(kLabel + 1 + (kColumns - middle.size()) / 2, middle.size(), middle);
  line.replace(line.size() - high.size(), high.size(), high);
  return line + "\n" +
         std::string(kLabel + 1 + (kColumns - std::min<std::size_t>(WidthOf(name), kColumns)) / 2, ' ') + name +
         "\n";
}

bool HasValues(const std::vector<double>& values) {
  return std::ranges::any_of(values, [](double value) { return std::isfinite(value); });
}

std::string Legend(const CurveText& curve, Letters letters) {
  const bool is_ascii = letters == Letters::kAscii;
  const bool has_forward = HasValues(curve.forward), has_backward = HasValues(curve.backward);
  std::string text;
  if (has_forward) text += (is_ascii ? "> " : "⣀⠤⠒⠉ ") + curve.forward_name + "   ";
  if (has_backward) text += (is_ascii ? "< " : "○ ") + curve.backward_name + "   ";
  if (has_forward && has_backward) text += is_ascii ? "x both" : "● both";
  return std::string(kLabel + 1, ' ') + text.substr(0, text.find_last_not_of(' ') + 1) + "\n";
}

}  // namespace

std::string PlotOf(const CurveText& curve, Letters letters) {
  Plot plot(curve);
  if (plot.IsEmpty()) return "";
  plot.PutForward(curve);
  plot.PutBackward(curve);
  std::string text = curve.title + "\n";
  for (int row = 0; row < kPlotRows; ++row) {
    const std::string line = fmt::format("{:>{}}{}{}", LabelOfRow(plot, row), kLabel,
                                         letters == Letters::kAscii ? "|" : "│", plot.Row(row, letters));
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  for (int column = -1; column < kColumns; ++column) {
    if (column < 0)
      text += std::string(kLabel, ' ') + (letters == Letters::kAscii ? "+" : "└");
    else
      text += letters == Letters::kAscii ? "-" : "─";
  }
  return text + "\n" + AxisLine(plot, curve.x_name) + Legend(curve, letters);
}

}  // namespace twinbench::report
