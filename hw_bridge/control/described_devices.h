#pragma once

#include <optional>

#include "hw_bridge/control/device_line.h"
#include "hw_bridge/control/dialogue_words.h"
#include "twin/core/machine.h"

/// Devices that are spoken to as a dialogue describes it (dialogue_words.h). Calls throw DeviceFault.
namespace twinbench::hw {

/// Says a command, and hears as the dialogue says how it went.
/// @param beyond  The answer may take so much longer than the timeout.
/// @throws DeviceFault kLimit, kRefused as the dialogue tells them apart; what DeviceLine throws.
void TellDescribed(DeviceLine& line, const ErrorWords& errors, const std::string& command, Duration beyond = {});

/// The answer to a query. @throws DeviceFault kRefused too, where it is a refusal.
std::string AskDescribed(DeviceLine& line, const ErrorWords& errors, const std::string& query,
                         Duration beyond = {});

/// The fields of an answer: a text in quotes holds no separator and loses them, blanks that separate count once.
/// @return nothing if a quote is not closed.
std::optional<std::vector<std::string>> SplitAnswer(const std::string& answer, const std::string& separator);

/// Whether a text in a number's place means that there is none.
bool IsNothing(const std::string& text, const std::vector<std::string>& nothing);
/// Whether the fields that begin at `from` are as they are where something is shown.
bool ShowsSomething(const std::vector<std::string>& texts, std::size_t from, const std::vector<std::string>& valid);

/// One sample of [read], field by field.
class DescribedSample {
 public:
  DescribedSample(DeviceLine line, DialogueWords words) : line_(std::move(line)), words_(std::move(words)) {}
  /// @return the numbers of these fields in SI, NaN where nothing is shown.
  std::vector<double> Read(const std::vector<std::string>& fields);

 private:
  double NumberOf(const std::vector<std::string>& texts, std::size_t field);
  DeviceLine line_;
  DialogueWords words_;
};

class DescribedAutocollimator : public Autocollimator {
 public:
  /// @param words  Their fields hold "x" and "y".
  DescribedAutocollimator(DeviceLine line, DialogueWords words) : sample_(std::move(line), std::move(words)) {}
  /// NaN where the mirror is out of range.
  AutocollimatorReading Read() override;

 private:
  DescribedSample sample_;
};

class DescribedThermometer : public Thermometer {
 public:
  /// @param words  Their fields hold "temperature".
  DescribedThermometer(DeviceLine line, DialogueWords words) : sample_(std::move(line), std::move(words)) {}
  double Read_degC() override { return sample_.Read({"temperature"})[0]; }

 private:
  DescribedSample sample_;
};

class DescribedGoniometer : public Goniometer {
 public:
  DescribedGoniometer(DeviceLine line, DialogueWords words) : line_(std::move(line)), words_(std::move(words)) {}
  void MoveTo(double yaw_rad, double tilt_rad) override;

 private:
  DeviceLine line_;
  DialogueWords words_;
};

class DescribedIndexer : public Indexer {
 public:
  DescribedIndexer(DeviceLine line, DialogueWords words, double move_timeout_s)
      : line_(std::move(line)), words_(std::move(words)), move_timeout_s_(move_timeout_s) {}
  /// What does not end as it should, or is stopped by the operator, is told the word that ends it.
  /// @throws DeviceFault kNotInPosition too, if it does not say within its time that it is seated.
  void IndexTo(int tooth, double angle_rad) override;

 private:
  void Seat(int tooth, double angle_rad);
  void SayStop();

  DeviceLine line_;
  DialogueWords words_;
  double move_timeout_s_;
};

}  // namespace twinbench::hw
