#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <variant>
#include <vector>

/// A page of results before anything is drawn: what is shown, in which order, with which numbers. The page in a browser and
/// the pictures as files are both drawn from this.
namespace twinbench::report {

/// What is plotted along an axis. The unit is empty where there is none.
struct FigureAxis {
  std::string name, unit;
  double low = NAN, high = NAN;  // its ends; NaN: as far as the points go
};

/// What a series is. Truth is known of a twin only and is, like what chance would do, drawn unlike anything that was estimated.
enum class SeriesRole { kEstimate, kTruth, kExpected, kBefore, kAfter };

/// Points of one curve, or bars.
struct FigureSeries {
  std::string name;
  SeriesRole role = SeriesRole::kEstimate;
  std::vector<double> x, y;  // as long as each other; NaN: not available. Bars of a figure with categories have no x
  std::vector<double> u;     // standard uncertainty of y; empty: none is stated
  double k = 2.0;            // coverage factor: the band is y +- k u
  std::vector<double> u_order = {};  // of a curve: standard uncertainty of the amplitude of its orders from 1 on; empty: none is stated
};

enum class FigureForm {
  kAngle,      // y against an angle [deg]: as polar plot, along a line, or by its harmonics
  kLine,       // y against x, joined in the order of the points
  kPoints,     // y against x, points
  kTrack,      // like kPoints, but both axes have the same scale
  kBars,       // a bar for each x
  kShares,     // a bar for each category, the series stacked; they add up to at most 1
  kRanks,      // a bar for each category, of any length
  kHistogram,  // a bar for each bin of equal width; x is its middle
};

struct Figure {
  FigureForm form = FigureForm::kLine;
  std::string title, note;
  FigureAxis x, y;
  std::vector<FigureSeries> series;
  std::vector<std::string> categories = {};  // what each bar is, where that is a word
  std::string file = {};                     // what its picture is called; empty: as its title
  double radius = NAN;                       // of the circle that is zero in a polar plot, in the unit of y; NaN: it has none
};

struct PageTable {
  std::string title;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;  // each as long as `columns`
  std::vector<std::string> links = {};         // of each row, from where the page is; empty: there is none
};

/// Lines as they are, in type of equal width.
struct PageText {
  std::string title, text;
};

/// Many figures of one kind, of which one is shown at a time: "before and after the extension", against "dwell", of "psd_a_x".
struct PageChoice {
  std::string title, note;
  std::vector<std::string> questions;             // "against", "of"
  std::vector<std::vector<std::string>> answers;  // of each figure, one a question
  std::vector<Figure> figures;                    // the first is shown first
};

/// Columns as long as each other, of which the reader of the page chooses which to plot against which.
struct PageColumns {
  struct Column {
    std::string name, unit;
    std::vector<double> values;  // NaN: not available
  };
  std::string title, note;
  std::vector<Column> columns;
  int x = 0, y = 1;  // what is plotted first
  int colour = -1;   // points have the colour of its values; -1: none
  int group = -1;    // points with the same value of it are one series; -1: all
};

/// A picture with physical size, row by row from the top.
struct PageImage {
  std::string title, note;
  int width = 0, height = 0;  // [pixels]
  double pitch_mm = 0.0;      // of a pixel
  std::string unit;           // of the values
  std::vector<double> values;
};

using PageBlock = std::variant<Figure, PageTable, PageText, PageChoice, PageColumns, PageImage>;

struct PageSection {
  std::string title, lead;
  std::vector<PageBlock> blocks;
};

/// How the verdict of a page is to be taken.
enum class VerdictTone { kPlain, kGood, kDoubt, kBad };

/// A number to be seen at a glance.
struct PageTile {
  std::string name, value, note = {};
  VerdictTone tone = VerdictTone::kPlain;
};

struct Page {
  std::string title;     // of the file and the page
  std::string subtitle;  // one line
  std::string verdict;   // one sentence; empty: there is none
  VerdictTone tone = VerdictTone::kPlain;
  std::vector<PageSection> sections;
  std::vector<PageTile> tiles = {};
};

}  // namespace twinbench::report
