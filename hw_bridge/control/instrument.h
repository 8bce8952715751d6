#pragma once

#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "twin/core/machine.h"
#include "twin/core/reading_column.h"

namespace twinbench::hw {

/// One instrument with some of the columns of a bench's readings, however its numbers come.
class Instrument {
 public:
  /// @param names    What its numbers are, in order: a column of readings.csv, "time_ns" (bench time of the
  /// sample),
  ///                 "status" (as in readings.csv), or "ignored".
  /// @param scale    A number times this is in its column's unit; empty: all 1.
  /// @param columns  Those of the bench that an instrument may fill.
  /// @param where    Of the names, for messages.
  /// @throws InputError if a name is none of them.
  Instrument(const std::vector<std::string>& names, const std::vector<double>& scale,
             const std::vector<ReadingColumn>& columns, const std::string& where);
  virtual ~Instrument() = default;

  /// What it shows now.
  virtual Reading Read() = 0;
  /// The same on the way to a reading.
  virtual Reading Look() { return Read(); }
  virtual bool Latches() const { return false; }
  /// @throws DeviceFault kRefused for lines where it latches at triggers only.
  virtual void Arm(int /*samples*/, int /*lines*/) {}
  /// Takes what was latched into `waiting`. @return false if some are lost.
  virtual bool Fetch() { return true; }

  /// Puts the numbers of a sample of this instrument into one of all.
  void Merge(const Reading& sample, Reading& into) const;

  std::deque<Reading> waiting;  // latched, in order
  bool stamps = false;          // its samples say when they were taken

 protected:
  struct Field {
    std::string name;
    ReadingColumn column;  // without a name: none
    double scale = 1.0;
  };
  const std::vector<Field>& fields() const { return fields_; }
  /// @param nothing  Texts in a number's place that mean that there is none.
  /// @return false if the text is not what the field holds.
  static bool Put(const Field& field, const std::string& text, const std::vector<std::string>& nothing,
                  Reading& sample);

 private:
  std::vector<Field> fields_;
};

/// The column that a name means. @throws InputError at `where` if it is none that an instrument of this bench
/// shows.
ReadingColumn InstrumentColumn(const std::string& name, const std::vector<ReadingColumn>& columns,
                               const std::string& where);

/// All instruments of a bench as one. A sample that none of them stamps has the time at which it was read.
class Instruments : public InstrumentSet {
 public:
  Instruments(std::vector<std::unique_ptr<Instrument>> all, Clock& clock) : all_(std::move(all)), clock_(clock) {}
  Reading Read() override;
  Reading Look() override;
  /// @throws DeviceFault kRefused if no instrument can latch.
  void Arm(int samples, int lines) override;
  LatchedSamples Latched() override;

 private:
  Reading AllNow(Reading (Instrument::*show)());
  bool AllHaveOne() const;
  Reading TakeOne(const std::vector<Reading>& now);

  std::vector<std::unique_ptr<Instrument>> all_;
  Clock& clock_;
};

}  // namespace twinbench::hw
