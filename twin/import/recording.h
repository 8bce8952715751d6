#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

/// A measured file as it was understood, before anything is said about a bench: columns of numbers and words, each
/// with the clock that it was read by. Numbers are still in the file's own units.
namespace twinbench::imports {

/// One quantity. Either numbers (`words` is empty) or words of which there are few different ones.
struct Column {
  std::string name;           // as the file has it, without its unit
  std::string unit;           // as the file has it; empty: it says none
  std::vector<double> value;  // NaN where the file has none; of words: their number in `words`
  std::vector<std::string> words;

  bool IsNumber() const { return words.empty(); }
};

/// A line of text between or above the rows.
struct TextLine {
  std::size_t row = 0;  // behind it
  std::string text;
};

/// Columns that were read at the same instants.
struct Track {
  std::string name;            // of the file, or of the part of it
  std::string clock = "none";  // what its time came from, in words; "none": rows in order only
  bool absolute = false;       // time_s counts from the start of 1970
  bool on_change = false;      // a value is written down when it changes: it holds until the next one
  std::vector<double> time_s;  // one a row; without a clock the row's number
  std::vector<Column> columns;
  std::map<std::string, double> numbers;  // named in the text above the rows: "Pixel scale", "Dec"
  std::vector<TextLine> lines;

  bool HasClock() const { return clock != "none"; }
  std::size_t Rows() const { return columns.empty() ? time_s.size() : columns.front().value.size(); }
};

/// Rows that were not taken, and why.
struct LeftOut {
  std::size_t count = 0;
  std::string why;
};

struct Recording {
  std::string file;
  std::string layout;             // what was recognised, in words
  bool parts_are_setups = false;  // its tracks follow each other; else they ran side by side
  std::string usual_angle = "deg";  // what its kind of file counts angles in where it does not say so
  std::vector<Track> tracks;
  std::vector<LeftOut> left_out;
  std::vector<std::string> remarks;  // what was taken for granted, a line each
};

}  // namespace twinbench::imports
