#include "twin/procedure/machine_journal.h"

#include <fmt/format.h>

namespace twinbench::procedure {
namespace {

std::string Places(const std::vector<double>& to) {
  std::string text;
  for (const double place : to) text += fmt::format(" {}", place);
  return text;
}

std::string Text(const Arc& a) {
  return fmt::format("arc {} {} {} {} {} {} {} {} {}", a.axes[0], a.axes[1], a.centre_m[0], a.centre_m[1],
                     a.sweep_rad, a.feed_m_s, a.triggers, a.first_trigger_rad, a.trigger_step_rad);
}

}  // namespace

struct MachineJournal::Devices : Clock, MachineController, InstrumentSet, MachineFixture, Indexer {
  Devices(MachineBench& its_inner, RunLog& its_log) : inner(its_inner), log(its_log) {}

  Time Now() const override { return inner.clock.Now(); }
  void Wait(Duration duration) override {
    inner.clock.Wait(duration);
    Note("clock", fmt::format("wait {}", duration.count()));
  }

  const std::vector<MachineAxis>& Axes() const override { return inner.machine.Axes(); }
  std::vector<AxisLimits> Travel() override { return inner.machine.Travel(); }
  std::vector<AxisState> State() override { return inner.machine.State(); }
  bool Settles(Duration within) override { return inner.machine.Settles(within); }
  void StartMove(const std::vector<double>& to, double feed_m_s) override {
    inner.machine.StartMove(to, feed_m_s);
    Note("machine", fmt::format("move {}{}", feed_m_s, Places(to)));
  }
  void StartArc(const Arc& arc) override {
    inner.machine.StartArc(arc);
    Note("machine", Text(arc));
  }
  void StartTurning(std::size_t axis, double speed_rad_s, Duration ramp) override {
    inner.machine.StartTurning(axis, speed_rad_s, ramp);
    Note("machine", fmt::format("turn {} {} {}", axis, speed_rad_s, ramp.count()));
  }
  void Stop() override {
    inner.machine.Stop();
    Note("machine", "stop");
  }
  void Home() override {
    inner.machine.Home();
    Note("machine", "home");
  }

  Reading Read() override {
    Reading shown = inner.instruments.Read();
    Note("instruments", "read");
    return shown;
  }
  Reading Look() override {
    Reading shown = inner.instruments.Look();
    Note("instruments", "look");
    return shown;
  }
  void Arm(int samples, int lines) override {
    inner.instruments.Arm(samples, lines);
    Note("instruments", fmt::format("arm {} {}", samples, lines));
  }
  LatchedSamples Latched() override { return inner.instruments.Latched(); }

  void Clear() override {
    inner.fixture.Clear();
    Note("fixture", "clear");
  }
  void Mount(int setup, const std::string& what) override {
    inner.fixture.Mount(setup, what);
    Note("fixture", fmt::format("mount {} {}", setup, what));
  }

  void IndexTo(int tooth, double angle_rad) override {
    inner.indexer->IndexTo(tooth, angle_rad);
    Note("indexer", fmt::format("index {}", tooth));
  }
  bool IsByHand() const override { return inner.indexer->IsByHand(); }

  void Note(const char* device, const std::string& request) {
    log.Called({inner.clock.Now(), device, request, ""});
  }

  MachineBench& inner;
  RunLog& log;
};

MachineJournal::MachineJournal(MachineBench inner, RunLog* log)
    : inner_(inner), devices_(log ? std::make_unique<Devices>(inner_, *log) : nullptr) {}
MachineJournal::~MachineJournal() = default;

MachineBench MachineJournal::Bench() {
  if (!devices_) return inner_;
  Indexer* indexer = inner_.indexer ? devices_.get() : nullptr;
  return {*devices_, *devices_, *devices_, *devices_, inner_.simulation, indexer};
}

}  // namespace twinbench::procedure
