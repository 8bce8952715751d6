#pragma once

#include <deque>

#include "hw_bridge/control/device_line.h"
#include "hw_bridge/control/dialogue_words.h"
#include "twin/core/machine.h"
#include "twin/core/reading_column.h"

namespace twinbench::hw {

/// What is said to an instrument and what it answers, as a bench file describes it: there is no code per
/// instrument.
struct InstrumentWords {
  /// What the fields of an answer are, in order: the name of a column of readings.csv, or one of "time_ns" (bench
  /// time of the sample), "status" (as in readings.csv), "ignored".
  std::vector<std::string> fields;
  std::vector<double> scale;               // a field times this is in its column's unit; empty: all 1
  std::string read = "INST:READ?";         // answered by one sample
  std::string look;                        // the same on the way to a reading; empty: as read
  /// At the machine's triggers, or at every {lines}-th line that it counts. Empty: it cannot latch, and is read with every
  /// look.
  std::string arm = "INST:ARM {samples}";
  std::string fetch = "INST:FETC?";        // answered by how many samples, 1 if some are lost, and the samples
  std::string separator = ",";             // of the fields
  std::vector<std::string> valid;          // as in ReadWords
  std::vector<std::string> nothing = {"9.91E37"};
  ErrorWords errors;
  std::string where = "fields";            // the bench file says what the fields are
};

/// What a bench file says of an instrument, with what its dialogue says. Fields of the dialogue are columns of the same name unless the
/// file names others; x, y and temperature are those of an autocollimator and a thermometer.
/// @param file     Its fields and scale, one a field of the dialogue, or none; `where` they stand.
/// @param columns  Those of the bench that an instrument may fill.
/// @throws InputError at file.where for another number of fields, a unit of another kind than the column's.
InstrumentWords WithDialogue(const InstrumentWords& file, const DialogueWords& dialogue,
                             const std::vector<ReadingColumn>& columns);

/// One instrument with some of the columns of a bench's readings.
class InstrumentBox {
 public:
  /// @param columns  Those of the bench that an instrument may fill.
  /// @throws InputError if a field is none of them.
  InstrumentBox(DeviceLine line, InstrumentWords words, const std::vector<ReadingColumn>& columns);

  bool Latches() const { return !words_.arm.empty(); }
  /// What it shows now.
  Reading Read() { return Ask(words_.read); }
  Reading Look() { return Ask(words_.look.empty() ? words_.read : words_.look); }
  /// @throws DeviceFault kRefused for lines where its words have no place for them.
  void Arm(int samples, int lines);
  /// Takes what was latched into `waiting`. @return false if some are lost.
  bool Fetch();

  /// Puts the numbers of a sample of this instrument into one of all.
  void Merge(const Reading& sample, Reading& into) const;

  std::deque<Reading> waiting;  // latched, in order
  bool stamps = false;          // its samples say when they were taken

 private:
  struct Field {
    std::string name;
    ReadingColumn column;  // without a name: none
    double scale = 1.0;
  };
  Reading Ask(const std::string& query);
  Reading Sample(const std::string& query, const std::vector<std::string>& texts, std::size_t from);
  bool Put(const Field& field, const std::string& text, Reading& sample) const;
  std::vector<std::string> Fields(const std::string& query, const std::string& answer);

  DeviceLine line_;
  InstrumentWords words_;
  std::vector<Field> fields_;
};

/// All instruments of a bench as one. A sample that none of them stamps has the time at which it was read.
class InstrumentBoxes : public InstrumentSet {
 public:
  InstrumentBoxes(std::vector<InstrumentBox> boxes, Clock& clock) : boxes_(std::move(boxes)), clock_(clock) {}
  Reading Read() override;
  Reading Look() override;
  /// @throws DeviceFault kRefused if no instrument can latch.
  void Arm(int samples, int lines) override;
  LatchedSamples Latched() override;

 private:
  Reading AllNow(Reading (InstrumentBox::*show)());
  bool AllHaveOne() const;
  Reading TakeOne(const std::vector<Reading>& now);

  std::vector<InstrumentBox> boxes_;
  Clock& clock_;
};

}  // namespace twinbench::hw
