#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "twin/import/layout.h"
#include "twin/import/map.h"
#include "twin/import/recording.h"

/// Files that are no plain tables: how each kind is recognised and read, or made a table.
namespace twinbench::imports {

/// True of `name = [1.0, 2.0 ...`, as Python and MATLAB have it.
bool OpensList(std::string_view line);

/// True of numbers and nothing else: all in one line, or one a line.
bool IsBareList(const std::vector<std::string_view>& lines);

/// A table in the text of a program, `const float lookup[16384] = { 63.92, 63.94, ... };`. Comments are skipped;
/// `float zero = 1.2;` beside it becomes a named number.
/// @param name  Of the array; empty: the longest, or those of one length where the names say which is the reference's.
/// @throws InputError if there is no such array with numbers.
void ReadArray(std::string_view text, const std::string& name, Recording& recording);

// The text that software of ball bars exports (`.b5r` and its kin): tags with the conditions of the test, then for
// each run its values, one a line at even steps of the angle.

/// True of tags that say a radius and a feed, an angle or a way round, and of lines of one number behind them.
bool IsBarExport(const std::vector<std::string_view>& lines);

/// The same as a table of angle, deviation and conditions. Tags that are not known say nothing.
/// @param said  What was taken for granted, a line each.
/// @throws InputError if no run has values.
std::string TableOfBarExport(std::string_view text, const std::string& file, std::vector<std::string>& said);

/// One line a change: name, date, time of day, value, as `camonitor` writes; each name is a track of its own that
/// holds its value until it changes. Lines that tell of connections, of arrays or of texts are counted and left
/// out.
/// @throws InputError if no line is such a change.
void ReadChanges(std::string_view text, Recording& recording);

/// True of lines among which are names of columns: a target, and runs that all say up or down.
bool AreCycles(const std::vector<std::string_view>& lines);

/// Tables of a positioning test after ISO 230-2: a row a target, a column a run. Approaches from below and from
/// above stand in a table each (the text above says which) or in columns whose names say it: "1 up", "run 2 -", "3
/// ↓". Entries are positions or deviations from the target, whichever they are closer to.
///
/// The track has the readings in the order in which such a test is driven: for every run all targets upwards, then
/// downwards. Columns: target, actual, direction, run.
/// @throws InputError if there is no such table, or nothing says the direction of the runs.
void ReadCycles(std::string_view text, const Layout& layout, Recording& recording);

/// True of lines that are nearly all "TGT_DATA[2]=-15", "REF_DATA_FWD[2,1]=-15.0037": a positioning test, a value a line.
bool AreIndexed(const std::vector<std::string_view>& lines);

/// The same as a table between tabs, a row a target, a column a run that its array's name calls up or down; "UNIT=mm" is the unit.
/// Empty if there is no list of targets, or no array beside it.
std::string TableOfIndexed(std::string_view text);

/// True of the target lists and runs that laser interferometers save (`.rtl`): "TARGET DATA::", "Targets :", "Run Target Data:".
bool AreLaserRuns(const std::vector<std::string_view>& lines);

/// The same as a table between tabs, a row a target, a column a run, up or down by the order of its targets.
/// @param said  What was taken for granted, a line each.
std::string TableOfLaserRuns(std::string_view text, std::vector<std::string>& said);

// Records of a program's log in which every quantity has a line: "Order given: [0.1, -0.2, 0.3]" above "Actual position: [...]".

/// True where lists of numbers under two names and more come again and again.
bool AreNamedLists(const std::vector<std::string_view>& lines);

/// A row a record, tabs between fields: "Order given.0", "Order given.1", ... as records in JSON have them, and what else has a
/// name and one value, such as a time stamp. A record ends where a name comes again. Other lines stay as they are.
std::string TableOfNamedLists(std::string_view text);

/// True of lines that are nearly all "target=5.0 actual=5.03", or of a log in which no line is a row of numbers but one sentence
/// comes again and again: "[INFO] moved to 5.0 mm, encoder 5.03 mm".
bool AreSentences(const std::vector<std::string_view>& lines);

/// The values of the sentence that comes most often as a table between tabs; names are the words before each. Other lines stay.
std::string TableOfSentences(std::string_view text);

/// True of a text that begins as JSON does: {"..., [{..., [[...
bool OpensRecords(const std::vector<std::string_view>& lines);

/// Records that a program wrote down in JSON: a list of objects, alone or anywhere in an object; an object a line; an
/// object of lists of one length; a list of lists. What an object holds further down has the names with a dot between
/// ("state.position"), an entry of a list its number ("position.0"). Single numbers beside the list are named numbers.
/// @throws InputError if the text is no JSON or has no such records.
void ReadRecords(std::string_view text, const Layout& layout, const ClockSettings& clock, Recording& recording);

/// The text export of a TwinCAT scope: rows of `key, value` that describe the channels, then rows in which every
/// group of channels has a time of its own [ms]. The key stands where a group begins, in front of its channels.
/// Values are exported with their scale applied. "Starttime of export" is a Windows file time.
/// @throws InputError if it has no row of names or no rows of numbers.
void ReadScope(std::string_view text, Recording& recording);

}  // namespace twinbench::imports
