#include "twin/report/page/svg_canvas.h"

#include <fmt/format.h>

#include <cmath>

#include "twin/report/page/page_json.h"

namespace twinbench::report {
namespace {

std::string StrokeOf(const Ink& ink) {
  return fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"{:g}\"{}", ink.colour, ink.width_px,
                     ink.dash.empty() ? "" : fmt::format(" stroke-dasharray=\"{}\"", ink.dash));
}

std::string PathOf(const Corners& corners) {
  std::string path;
  bool drawing = false;
  for (const auto& [x, y] : corners) {
    const bool is_there = std::isfinite(x) && std::isfinite(y);
    if (is_there) path += fmt::format("{}{:.1f} {:.1f}", drawing ? "L" : "M", x, y);
    drawing = is_there;
  }
  return path;
}

}  // namespace

SvgCanvas::SvgCanvas(double width_px, double height_px)
    : svg_(fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:g} {1:g}\" width=\"{0:g}\" height=\"{1:g}\" "
                       "font-family=\"system-ui, 'Segoe UI', Roboto, 'Noto Sans', 'DejaVu Sans', sans-serif\">\n"
                       "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
                       width_px, height_px)) {}

void SvgCanvas::Line(double x1, double y1, double x2, double y2, const Ink& ink) {
  Path({{x1, y1}, {x2, y2}}, ink);
}

void SvgCanvas::Path(const Corners& corners, const Ink& ink) {
  svg_ += fmt::format("<path d=\"{}\" {}/>\n", PathOf(corners), StrokeOf(ink));
}

void SvgCanvas::Area(const Corners& corners, const Ink& ink) {
  svg_ += fmt::format("<path d=\"{}Z\" fill=\"{}\" fill-opacity=\"{:g}\"/>\n", PathOf(corners), ink.colour, ink.opacity);
}

void SvgCanvas::Box(double x, double y, double width, double height, const Ink& fill, bool outlined) {
  svg_ += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" {}/>\n", x, y, width, height,
                      outlined ? StrokeOf(fill) : fmt::format("fill=\"{}\"", fill.colour));
}

void SvgCanvas::Circle(double x, double y, double radius, const Ink& ink) {
  svg_ += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" {}/>\n", x, y, radius, StrokeOf(ink));
}

void SvgCanvas::Dot(double x, double y, const Ink& ink, bool open) {
  if (!std::isfinite(x) || !std::isfinite(y)) return;
  svg_ += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.4\" fill=\"{}\" stroke=\"{}\"/>\n", x, y, open ? "#fff" : ink.colour, ink.colour);
}

void SvgCanvas::Text(double x, double y, const std::string& text, const std::string& anchor, double size_px, bool bold, bool upright) {
  svg_ += fmt::format("<text x=\"{0:.1f}\" y=\"{1:.1f}\" text-anchor=\"{2}\" font-size=\"{3:g}\" fill=\"{4}\"{5}{6}>{7}</text>\n", x, y, anchor, size_px,
                      bold ? "#1c2126" : "#545c66", bold ? " font-weight=\"600\"" : "",
                      upright ? fmt::format(" transform=\"rotate(-90 {:.1f} {:.1f})\"", x, y) : "", ForHtml(text));
}

std::string SvgCanvas::Text() const {
  return svg_ + "</svg>\n";
}

}  // namespace twinbench::report
