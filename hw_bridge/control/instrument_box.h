#pragma once

#include "hw_bridge/control/device_line.h"
#include "hw_bridge/control/dialogue_words.h"
#include "hw_bridge/control/instrument.h"

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

/// An instrument that is spoken to in lines.
class InstrumentBox : public Instrument {
 public:
  /// @param columns  Those of the bench that an instrument may fill.
  /// @throws InputError if a field is none of them.
  InstrumentBox(DeviceLine line, InstrumentWords words, const std::vector<ReadingColumn>& columns);

  Reading Read() override { return Ask(words_.read); }
  Reading Look() override { return Ask(words_.look.empty() ? words_.read : words_.look); }
  bool Latches() const override { return !words_.arm.empty(); }
  /// @throws DeviceFault kRefused for lines where its words have no place for them.
  void Arm(int samples, int lines) override;
  bool Fetch() override;

 private:
  Reading Ask(const std::string& query);
  Reading Sample(const std::string& query, const std::vector<std::string>& texts, std::size_t from);
  std::vector<std::string> Fields(const std::string& query, const std::string& answer);

  DeviceLine line_;
  InstrumentWords words_;
};

}  // namespace twinbench::hw
