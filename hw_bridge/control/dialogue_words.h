#pragma once

#include <string>
#include <vector>

#include "twin/core/scenario_schema.h"

/// What is said to an instrument and what it answers, as a TOML file describes it: there is no code per instrument.
/// docs/hardware.md lists the keys; ready ones are built in from hw_bridge/dialogues.
namespace twinbench::hw {

inline constexpr const char* kAnyLineEnd = "any";

/// What its lines look like.
struct LineWords {
  std::string ends = "LF";         // of a line that is sent: LF, CR, CRLF
  std::string answer_ends = "LF";  // of a line that comes, or "any"; a CR before an LF counts to it
  std::string answer_begins;       // every answer does; taken off
  std::string separator = ",";     // between fields; blanks count once
  bool operator==(const LineWords&) const = default;
};
/// Lines of whoever does not care how they end.
LineWords WithAnyLineEnd();

/// How it says that something went wrong.
struct ErrorWords {
  std::string ask = "SYST:ERR?";      // query behind a command; empty: there is none
  std::string none = "0,";            // what its answer begins with where all is well
  std::string limit = "-222,";        // ... where the command would go beyond a limit
  std::string acknowledged;           // a command is answered by a line that begins so; empty: by none
  std::vector<std::string> refusals;  // an answer that begins so is a refusal
  bool operator==(const ErrorWords&) const = default;
};

/// A sample. Fields: "x", "y", "temperature", a column of readings.csv, "time_ns", "status", "ignored", or a name to which the
/// bench file gives a column.
struct ReadWords {
  std::string ask, look;            // look: on the way to a reading, where something is nulled; empty: as ask
  std::vector<std::string> fields;
  std::vector<std::string> units;    // one a field; empty: a pure number, or the column's unit
  std::vector<double> scale;         // one a field; without it 1
  std::vector<std::string> valid;    // what a field's text must be, else nothing is shown; empty: anything
  std::vector<std::string> nothing;  // texts in a number's place that mean that there is none
};

struct DialogueWords {
  std::string name, title;
  std::string identify = "*IDN?";  // query that tells who it is; empty: it does not
  LineWords line;
  ErrorWords errors;
  ReadWords read;
  std::string arm, fetch;    // of a memory, as InstrumentWords
  std::string move, done;    // an indexer: seats at {tooth}, which is at {deg}; query whether it is seated
  std::string seated = "1";  // what `done` is answered then
  std::string stop;          // command that ends a seating, which is not answered; empty: there is none
  std::string tilt, tilt_unit = "arcsec";  // a goniometer: turns to {yaw}, {tilt}

  std::vector<ScenarioKey> Keys();
};

/// @param name  Of the file, for messages.
/// @throws InputError with file:line for a syntax error, an unknown key, unit or place in braces (naming the
///         nearest), lists of another length than the fields, a file that describes nothing.
DialogueWords ParseDialogue(const std::string& text, const std::string& name);

struct ReadyDialogue {
  std::string name, text;
};
/// Those of hw_bridge/dialogues.
const std::vector<ReadyDialogue>& ReadyDialogues();
DialogueWords ReadyDialogueNamed(const std::string& name);

/// A ready one by its name, or a file by its path, which ends in ".toml".
/// @param folder  From which a path is found.
/// @param where   Of the key that asks for it, for messages.
DialogueWords LoadDialogue(const std::string& name_or_path, const std::string& folder, const std::string& where);

/// The bytes of LF, CR or CRLF; none of "any".
std::string EndOfLine(const std::string& name);

/// What a number in this unit is in SI; 1 for "". @throws InputError at `where` for one that there is not.
double UnitToSI(const std::string& unit, const std::string& where);

/// What a field of the dialogue must be multiplied by to be in the unit in which a column's name ends ("bar_um").
/// @throws InputError at `where` if they are not of one kind, as um and deg.
double ScaleToColumn(const std::string& unit, const std::string& column, const std::string& where);

}  // namespace twinbench::hw
