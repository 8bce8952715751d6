#include "twin/core/call_text.h"
#include "twin/core/device_call.h"

namespace twinbench {

// Not in the unnamed namespace: a type of the header holds them, and would be local to this file as well.

using Ask = AskedBench::Ask;

class AskedClock : public Clock {
 public:
  AskedClock(const Ask& ask, std::function<Time()> now) : ask_(ask), now_(std::move(now)) {}
  Time Now() const override { return now_(); }
  void Wait(Duration duration) override { ask_("clock", (CallWords() << "wait" << duration.count()).text()); }

 private:
  const Ask& ask_;
  std::function<Time()> now_;
};

class AskedTable : public RotaryTable {
 public:
  AskedTable(const Ask& ask, std::string name) : ask_(ask), name_(std::move(name)) {}
  void StartMove(double angle_rad) override { ask_(name_, (CallWords() << "move" << angle_rad).text()); }
  bool Settles(Duration within) override {
    return ask_(name_, (CallWords() << "settles" << within.count()).text()).text == "1";
  }
  TableState State() override { return ParseState(ask_(name_, "state").text); }
  void Stop() override { ask_(name_, "stop"); }
  void Home() override { ask_(name_, "home"); }

 private:
  const Ask& ask_;
  std::string name_;
};

class AskedAdc : public AdConverter {
 public:
  explicit AskedAdc(const Ask& ask) : ask_(ask) {}
  Acquisition Acquire(int n_samples, bool keep_raw) override {
    CallWords words;
    words << "acquire" << std::int64_t{n_samples};
    return ask_("adc", (keep_raw ? words << "raw" : words).text()).block;
  }

 private:
  const Ask& ask_;
};

class AskedAutocollimator : public Autocollimator {
 public:
  explicit AskedAutocollimator(const Ask& ask) : ask_(ask) {}
  AutocollimatorReading Read() override {
    const std::string text = ask_("autocollimator", "read").text;
    CallReader words(text);
    const double yaw_rad = words.Number();
    return {yaw_rad, words.Number()};
  }

 private:
  const Ask& ask_;
};

class AskedThermometer : public Thermometer {
 public:
  explicit AskedThermometer(const Ask& ask) : ask_(ask) {}
  double Read_degC() override {
    const std::string text = ask_("thermometer", "read").text;
    return CallReader(text).Number();
  }

 private:
  const Ask& ask_;
};

class AskedGoniometer : public Goniometer {
 public:
  explicit AskedGoniometer(const Ask& ask) : ask_(ask) {}
  void MoveTo(double yaw_rad, double tilt_rad) override {
    ask_("goniometer", (CallWords() << "move" << yaw_rad << tilt_rad).text());
  }

 private:
  const Ask& ask_;
};

class AskedFixture : public Fixture {
 public:
  explicit AskedFixture(const Ask& ask) : ask_(ask) {}
  void Mount(int setup, double clamp_rad, double reseat_rad) override {
    ask_("fixture", (CallWords() << "mount" << std::int64_t{setup} << clamp_rad << reseat_rad).text());
  }

 private:
  const Ask& ask_;
};

struct AskedBench::Devices {
  Devices(Ask its_ask, std::function<Time()> now) : ask(std::move(its_ask)), clock(ask, std::move(now)) {}

  Ask ask;
  AskedClock clock;
  AskedTable target{ask, "target"}, reference{ask, "reference"};
  AskedAdc adc{ask};
  AskedAutocollimator autocollimator{ask};
  AskedThermometer thermometer{ask};
  AskedGoniometer goniometer{ask};
  AskedFixture fixture{ask};
};

AskedBench::AskedBench(Ask ask, std::function<Time()> now, Simulation* simulation)
    : devices_(std::make_unique<Devices>(std::move(ask), std::move(now))), simulation_(simulation) {}

AskedBench::~AskedBench() = default;

RotaryBench AskedBench::Bench() {
  Devices& d = *devices_;
  return {d.clock,       d.target,     d.reference, d.adc,      d.autocollimator,
          d.thermometer, d.goniometer, d.fixture,   simulation_};
}

}  // namespace twinbench
