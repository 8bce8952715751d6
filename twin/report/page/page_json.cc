#include "twin/report/page/page_json.h"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "twin/core/errors.h"
#include "twin/report/page/named_numbers.h"

namespace twinbench::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kTitleMark = "<!--TITLE-->";
constexpr std::string_view kDataMark = "<!--DATA-->";

// In the order of their enumerations.
constexpr std::array kForms = {"angle", "line", "points", "track", "bars", "shares", "ranks", "histogram"};
constexpr std::array kRoles = {"estimate", "truth", "expected", "before", "after"};
constexpr std::array kTones = {"plain", "good", "doubt", "bad"};

const char* Word(FigureForm form) { return kForms.at(static_cast<std::size_t>(form)); }
const char* Word(SeriesRole role) { return kRoles.at(static_cast<std::size_t>(role)); }
const char* Word(VerdictTone tone) { return kTones.at(static_cast<std::size_t>(tone)); }

Json AxisJson(const FigureAxis& axis) {
  Json made = {{"name", axis.name}, {"unit", ShownUnit(axis.unit)}};
  if (std::isfinite(axis.low) && std::isfinite(axis.high)) made["ends"] = {axis.low, axis.high};
  return made;
}

Json SeriesJson(const FigureSeries& series) {
  Json made = {{"name", series.name}, {"role", Word(series.role)}, {"x", series.x}, {"y", series.y}};
  if (!series.u.empty()) made["u"] = series.u, made["k"] = series.k;
  return made;
}

Json BlockJson(const Figure& figure) {
  Json made = {{"type", "figure"}, {"form", Word(figure.form)}, {"title", figure.title}, {"note", figure.note},
               {"x", AxisJson(figure.x)}, {"y", AxisJson(figure.y)}, {"series", Json::array()}};
  for (const FigureSeries& series : figure.series) made["series"].push_back(SeriesJson(series));
  if (!figure.categories.empty()) made["categories"] = figure.categories;
  if (std::isfinite(figure.radius)) made["radius"] = figure.radius;
  return made;
}

Json BlockJson(const PageTable& table) {
  return {{"type", "table"}, {"title", table.title}, {"columns", table.columns}, {"rows", table.rows}, {"links", table.links}};
}

Json BlockJson(const PageText& text) {
  return {{"type", "text"}, {"title", text.title}, {"text", text.text}};
}

Json BlockJson(const PageChoice& choice) {
  Json made = {{"type", "choice"}, {"title", choice.title}, {"note", choice.note}, {"questions", choice.questions},
               {"answers", choice.answers}, {"figures", Json::array()}};
  for (const Figure& figure : choice.figures) made["figures"].push_back(BlockJson(figure));
  return made;
}

Json BlockJson(const PageColumns& columns) {
  Json made = {{"type", "columns"}, {"title", columns.title}, {"note", columns.note}, {"columns", Json::array()},
               {"x", columns.x}, {"y", columns.y}, {"colour", columns.colour}, {"group", columns.group}};
  for (const PageColumns::Column& column : columns.columns)
    made["columns"].push_back({{"name", column.name}, {"unit", ShownUnit(column.unit)}, {"values", column.values}});
  return made;
}

Json BlockJson(const PageImage& image) {
  return {{"type", "image"}, {"title", image.title}, {"note", image.note}, {"width", image.width}, {"height", image.height},
          {"pitch_mm", image.pitch_mm}, {"unit", image.unit}, {"values", image.values}};
}

Json SectionJson(const PageSection& section) {
  Json made = {{"title", section.title}, {"lead", section.lead}, {"blocks", Json::array()}};
  for (const PageBlock& block : section.blocks)
    made["blocks"].push_back(std::visit([](const auto& b) { return BlockJson(b); }, block));
  return made;
}

void Replace(std::string& text, std::string_view mark, const std::string& by) {
  const std::size_t at = text.find(mark);
  Require(at != std::string::npos, "the page's markup has a place for title and data");
  text.replace(at, mark.size(), by);
}

std::string WithReplaced(const std::string& text, const std::vector<std::pair<char, const char*>>& by) {
  std::string safe;
  safe.reserve(text.size());
  for (const char c : text) {
    const char* instead = nullptr;
    for (const auto& [letter, replacement] : by) {
      if (letter == c) instead = replacement;
    }
    instead ? safe += instead : safe += c;
  }
  return safe;
}

}  // namespace

std::string PageJson(const Page& page) {
  Json made = {{"title", page.title}, {"subtitle", page.subtitle}, {"verdict", page.verdict},
               {"tone", Word(page.tone)}, {"tiles", Json::array()}, {"sections", Json::array()}};
  for (const PageTile& tile : page.tiles)
    made["tiles"].push_back({{"name", tile.name}, {"value", tile.value}, {"note", tile.note}, {"tone", Word(tile.tone)}});
  for (const PageSection& section : page.sections) made["sections"].push_back(SectionJson(section));
  // A name that is no UTF-8 must not keep the rest from being shown.
  return made.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string ForScriptElement(const std::string& text) {
  return WithReplaced(text, {{'<', "\\u003c"}, {'>', "\\u003e"}, {'&', "\\u0026"}});
}

std::string ForHtml(const std::string& text) {
  return WithReplaced(text, {{'<', "&lt;"}, {'>', "&gt;"}, {'&', "&amp;"}, {'"', "&quot;"}, {'\'', "&#39;"}});
}

std::string PageHtml(const Page& page, std::string_view markup) {
  std::string html(markup);
  Replace(html, kDataMark, ForScriptElement(PageJson(page)));  // first: a title may look like the mark of the data
  Replace(html, kTitleMark, ForHtml(page.title));
  return html;
}

}  // namespace twinbench::report
