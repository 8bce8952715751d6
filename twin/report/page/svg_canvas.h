#pragma once

#include <string>
#include <utility>
#include <vector>

namespace twinbench::report {

/// How a stroke or a fill looks.
struct Ink {
  std::string colour = "#1c2126";
  double width_px = 1.0;
  std::string dash = {};  // "7 4"; empty: solid
  double opacity = 1.0;
};

using Corners = std::vector<std::pair<double, double>>;  // [px], y down

/// An SVG picture in the making. Text is escaped here and nowhere else.
class SvgCanvas {
 public:
  SvgCanvas(double width_px, double height_px);

  void Line(double x1, double y1, double x2, double y2, const Ink& ink);
  void Path(const Corners& corners, const Ink& ink);  // a gap where a corner is NaN
  void Area(const Corners& corners, const Ink& ink);
  void Box(double x, double y, double width, double height, const Ink& fill, bool outlined);
  void Circle(double x, double y, double radius, const Ink& ink);
  void Dot(double x, double y, const Ink& ink, bool open);
  /// @param anchor  "start", "middle" or "end".
  void Text(double x, double y, const std::string& text, const std::string& anchor = "start", double size_px = 12.0,
            bool bold = false, bool upright = false);

  std::string Text() const;

 private:
  std::string svg_;
};

}  // namespace twinbench::report
