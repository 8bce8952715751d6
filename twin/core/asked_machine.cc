#include "twin/core/call_text.h"
#include "twin/core/machine_call.h"
#include "twin/core/sample_text.h"

namespace twinbench {

struct AskedMachine::Devices : Clock, MachineController, InstrumentSet, MachineFixture, Indexer {
  Devices(Ask its_ask, std::function<Time()> its_now, Parts its_parts)
      : ask(std::move(its_ask)), now(std::move(its_now)), parts(std::move(its_parts)) {}

  Time Now() const override { return now(); }
  void Wait(Duration duration) override { ask(kClockDevice, (CallWords() << "wait" << duration.count()).text()); }

  const std::vector<MachineAxis>& Axes() const override { return parts.axes; }
  std::vector<AxisLimits> Travel() override { return ParseTravel(ask("machine", "travel")); }
  std::vector<AxisState> State() override { return ParseStates(ask("machine", "state")); }
  bool Settles(Duration within) override {
    return ask("machine", (CallWords() << "settles" << within.count()).text()) == "1";
  }
  void StartMove(const std::vector<double>& to, double feed_m_s) override {
    CallWords words;
    words << "move" << feed_m_s;
    for (const double place : to) words << place;
    ask("machine", words.text());
  }
  void StartArc(const Arc& a) override {
    CallWords words;
    words << "arc" << static_cast<std::int64_t>(a.axes[0]) << static_cast<std::int64_t>(a.axes[1]);
    words << a.centre_m[0] << a.centre_m[1] << a.sweep_rad << a.feed_m_s << std::int64_t{a.triggers};
    ask("machine", (words << a.first_trigger_rad << a.trigger_step_rad).text());
  }
  void StartTurning(std::size_t axis, double speed_rad_s, Duration ramp) override {
    CallWords words;
    ask("machine", (words << "turn" << static_cast<std::int64_t>(axis) << speed_rad_s << ramp.count()).text());
  }
  void Stop() override { ask("machine", "stop"); }
  void Home() override { ask("machine", "home"); }

  Reading Read() override { return ParseSample(ask("instruments", "read"), parts.shown); }
  Reading Look() override { return ParseSample(ask("instruments", "look"), parts.shown); }
  void Arm(int samples, int lines) override {
    ask("instruments", (CallWords() << "arm" << std::int64_t{samples} << std::int64_t{lines}).text());
  }
  LatchedSamples Latched() override { return ParseLatched(ask("instruments", "latched"), parts.shown); }

  void Clear() override { ask("fixture", "clear"); }
  void Mount(int setup, const std::string& what) override {
    ask("fixture", (CallWords() << "mount" << std::int64_t{setup} << what).text());
  }

  void IndexTo(int tooth, double angle_rad) override {
    ask("indexer", (CallWords() << "index" << std::int64_t{tooth} << angle_rad).text());
  }
  bool IsByHand() const override { return ask("indexer", "by_hand") == "1"; }

  Ask ask;
  std::function<Time()> now;
  Parts parts;
};

AskedMachine::AskedMachine(Ask ask, std::function<Time()> now, Parts parts)
    : devices_(std::make_unique<Devices>(std::move(ask), std::move(now), std::move(parts))) {}

AskedMachine::~AskedMachine() = default;

MachineBench AskedMachine::Bench() {
  Devices& d = *devices_;
  return {d, d, d, d, d.parts.simulation, d.parts.has_indexer ? &d : nullptr};
}

}  // namespace twinbench
