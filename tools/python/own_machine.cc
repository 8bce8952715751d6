#include "tools/python/own_machine.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <utility>

#include "tools/python/own_calls.h"
#include "twin/benches/registry.h"
#include "twin/core/bench_format.h"
#include "twin/core/device_fault.h"

namespace twinbench::python {
namespace {

namespace py = pybind11;

double OrInfinite(const py::object& number, double infinity) {
  return number.is_none() ? infinity : number.cast<double>();
}

}  // namespace

/// The devices one by one.
namespace own {

class MachineClock : public twinbench::Clock {
 public:
  explicit MachineClock(const py::object& bench) : bench_(bench) {}
  Time Now() const override { return Time(FromSeconds(Ask<double>(bench_, "now_s"))); }
  void Wait(Duration duration) override { Ask(bench_, "wait", ToSeconds(duration)); }

 private:
  const py::object& bench_;
};

AxisState AxisStateOf(const py::handle& state) {
  const auto get = [&](const char* name) { return state.attr(name); };
  return {get("commanded").cast<double>(), get("encoder").cast<double>(), get("moving").cast<bool>(), get("in_position").cast<bool>(),
          get("referenced").cast<bool>(),  get("limit").cast<int>(),      get("fault").cast<std::string>()};
}

class Controller : public MachineController {
 public:
  Controller(const py::object& bench, std::vector<MachineAxis> axes) : bench_(bench), axes_(std::move(axes)) {}
  const std::vector<MachineAxis>& Axes() const override { return axes_; }
  std::vector<AxisLimits> Travel() override {
    return Asked("travel", [&] {
      std::vector<AxisLimits> travel;
      for (const py::handle& axis : bench_.attr("travel")()) {
        const auto [lower, upper] = axis.cast<std::pair<py::object, py::object>>();
        travel.push_back({.lower = OrInfinite(lower, -INFINITY), .upper = OrInfinite(upper, INFINITY)});
      }
      RequireOneEach(travel.size(), "travel");
      return travel;
    });
  }
  /// What the bench says of its travel holds before it is asked to go beyond.
  void StartMove(const std::vector<double>& to, double feed_m_s) override {
    const std::vector<AxisLimits> travel = Travel();
    for (std::size_t k = 0; k < to.size(); ++k)
      if (!(to[k] >= travel[k].lower && to[k] <= travel[k].upper))
        throw DeviceFault(FaultKind::kLimit, axes_[k].name,
                          fmt::format("{:.6g} {} lies beyond its travel", to[k] / axes_[k].to_SI(), axes_[k].unit()));
    Ask(bench_, "start_move", to, feed_m_s);
  }
  void StartArc(const Arc& arc) override {
    Ask(bench_, "start_arc", std::pair(arc.axes[0], arc.axes[1]), std::pair(arc.centre_m[0], arc.centre_m[1]), arc.sweep_rad, arc.feed_m_s,
        arc.triggers, arc.first_trigger_rad, arc.trigger_step_rad);
  }
  void StartTurning(std::size_t axis, double speed_rad_s, Duration ramp) override {
    Ask(bench_, "start_turning", axis, speed_rad_s, ToSeconds(ramp));
  }
  bool Settles(Duration within) override { return Ask<bool>(bench_, "settles", ToSeconds(within)); }
  std::vector<AxisState> State() override {
    return Asked("state", [&] {
      std::vector<AxisState> states;
      for (const py::handle& state : bench_.attr("state")()) states.push_back(AxisStateOf(state));
      RequireOneEach(states.size(), "state");
      return states;
    });
  }
  void Stop() override { Ask(bench_, "stop"); }
  void Home() override { Ask(bench_, "home"); }

 private:
  void RequireOneEach(std::size_t entries, const char* method) const {
    if (entries != axes_.size())
      throw BenchError(fmt::format("{}() of the Python bench: returned {} entries; expected one for each of {} axes", method, entries,
                                   axes_.size()));
  }

  const py::object& bench_;
  std::vector<MachineAxis> axes_;
};

class Instruments : public InstrumentSet {
 public:
  Instruments(const py::object& bench, const twinbench::Clock& clock, std::vector<ReadingColumn> columns)
      : bench_(bench), clock_(clock), columns_(std::move(columns)) {}
  Reading Read() override { return Shown("read"); }
  Reading Look() override { return Shown("look"); }
  void Arm(int samples, int lines) override { Ask(bench_, "arm", samples, lines); }
  LatchedSamples Latched() override {
    return Asked("latched", [&] {
      LatchedSamples latched;
      const auto [samples, overrun] = bench_.attr("latched")().cast<std::pair<py::list, bool>>();
      for (const py::handle& sample : samples) {
        const auto [time_s, shown] = sample.cast<std::pair<double, py::object>>();
        latched.samples.push_back(SampleOf("latched", shown, Time(FromSeconds(time_s))));
      }
      latched.overrun = overrun;
      return latched;
    });
  }

 private:
  Reading Shown(const char* method) {
    const Time now = clock_.Now();
    return Asked(method, [&] { return SampleOf(method, bench_.attr(method)(), now); });
  }

  /// {column: number in its unit}, or the name of a status.
  Reading SampleOf(const char* method, const py::object& shown, Time at) const {
    Reading sample;
    sample.time = at;
    if (py::isinstance<py::str>(shown)) {
      const auto status = ReadingStatusOf(shown.cast<std::string>());
      if (!status) throw BenchError(std::string(method) + "() of the Python bench: returned an unknown status");
      sample.status = *status;
      return sample;
    }
    for (const auto& [name, value] : shown.cast<py::dict>()) Enter(method, name.cast<std::string>(), value.cast<double>(), sample);
    return sample;
  }

  void Enter(const char* method, const std::string& name, double value, Reading& sample) const {
    std::string known;
    for (const ReadingColumn& column : columns_) {
      known += (known.empty() ? "" : ", ") + column.name;
      if (column.name != name) continue;
      if (std::isfinite(value) && !column.parse(sample, fmt::format("{}", value)))
        throw BenchError(fmt::format("{}() of the Python bench: {} is {}; expected {}", method, name, value, column.expected));
      return;
    }
    throw BenchError(fmt::format("{}() of the Python bench: shows {}; the instruments of this bench show {}", method, name, known));
  }

  const py::object& bench_;
  const twinbench::Clock& clock_;
  std::vector<ReadingColumn> columns_;
};

class Hands : public MachineFixture {
 public:
  explicit Hands(const py::object& bench) : bench_(bench) {}
  void Clear() override { Ask(bench_, "clear"); }
  void Mount(int setup, const std::string& what) override { Ask(bench_, "mount", setup, what); }

 private:
  const py::object& bench_;
};

class Teeth : public Indexer {
 public:
  explicit Teeth(const py::object& bench) : bench_(bench) {}
  void IndexTo(int tooth, double angle_rad) override { Ask(bench_, "index_to", tooth, angle_rad); }

 private:
  const py::object& bench_;
};

}  // namespace own

MachineParts PartsOf(const Scenario& scenario) {
  const Bench& bench = BenchOf(scenario);
  if (!bench.drive)
    throw InputError(scenario.bench, "this bench has no machine that is driven", BenchesWhere([](const Bench& b) { return b.drive != nullptr; }));
  const auto twin = bench.make_devices(scenario);
  const MachineBench devices = twin->Devices();
  MachineParts parts{devices.machine.Axes(), devices.machine.Travel(), {}, {}, devices.indexer != nullptr};
  for (const AxisState& axis : devices.machine.State()) parts.start.push_back(axis.encoder);
  for (const ReadingColumn& column : InstrumentColumns(bench.format->columns)) parts.columns.push_back(column.name);
  return parts;
}

struct OwnMachineBench::Parts {
  Parts(py::object its_bench, const MachineParts& of, std::vector<ReadingColumn> columns)
      : bench(std::move(its_bench)), machine(bench, of.axes), instruments(bench, clock, std::move(columns)), has_indexer(of.has_indexer) {}

  py::object bench;
  own::MachineClock clock{bench};
  own::Controller machine;
  own::Instruments instruments;
  own::Hands fixture{bench};
  own::Teeth indexer{bench};
  bool has_indexer;
};

OwnMachineBench::OwnMachineBench(py::object bench, const Scenario& scenario) {
  const MachineParts parts = PartsOf(scenario);
  RequireMethods(bench, {"now_s", "wait", "travel", "start_move", "start_arc", "start_turning", "settles", "state", "stop", "home", "read",
                         "look", "arm", "latched", "clear", "mount"});
  if (parts.has_indexer) RequireMethods(bench, {"index_to"});
  parts_ = std::make_unique<Parts>(std::move(bench), parts, InstrumentColumns(BenchOf(scenario).format->columns));
}

OwnMachineBench::~OwnMachineBench() {
  const py::gil_scoped_acquire lock;
  parts_.reset();
}

MachineBench OwnMachineBench::Devices() {
  Parts& p = *parts_;
  return {p.clock, p.machine, p.instruments, p.fixture, nullptr, p.has_indexer ? &p.indexer : nullptr};
}

}  // namespace twinbench::python
