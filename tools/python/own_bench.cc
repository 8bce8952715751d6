#include "tools/python/own_bench.h"

#include <pybind11/numpy.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "tools/python/own_calls.h"
#include "twin/core/errors.h"

namespace twinbench::python {
namespace {

namespace py = pybind11;
using Samples = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Codes = py::array_t<std::int16_t, py::array::c_style | py::array::forcecast>;

}  // namespace

/// The devices one by one.
namespace own {

class Clock : public twinbench::Clock {
 public:
  explicit Clock(const py::object& bench) : bench_(bench) {}
  Time Now() const override { return Time(FromSeconds(Ask<double>(bench_, "now_s"))); }
  void Wait(Duration duration) override { Ask(bench_, "wait", ToSeconds(duration)); }

 private:
  const py::object& bench_;
};

TableState StateOf(const py::object& state) {
  const auto get = [&](const char* name) { return state.attr(name); };
  return {get("commanded_rad").cast<double>(), get("encoder_rad").cast<double>(), get("moving").cast<bool>(),
          get("in_position").cast<bool>(),     get("referenced").cast<bool>(),    get("limit").cast<int>(),
          get("fault").cast<std::string>()};
}

class Table : public RotaryTable {
 public:
  Table(const py::object& bench, std::string name) : bench_(bench), name_(std::move(name)) {}
  void StartMove(double angle_rad) override { Ask(bench_, "start_move", name_, angle_rad); }
  bool Settles(Duration within) override { return Ask<bool>(bench_, "settles", name_, ToSeconds(within)); }
  TableState State() override {
    return Asked("state", [&] { return StateOf(bench_.attr("state")(name_)); });
  }
  void Stop() override { Ask(bench_, "stop", name_); }
  void Home() override { Ask(bench_, "home", name_); }

 private:
  const py::object& bench_;
  std::string name_;
};

ChannelBlock BlockOf(const Samples& volts, py::ssize_t channel) {
  const auto samples = volts.unchecked<2>();
  const py::ssize_t n = samples.shape(0);
  ChannelBlock block{0.0, 0.0, samples(0, channel), samples(0, channel)};
  for (py::ssize_t i = 0; i < n; ++i) {
    block.mean_V += samples(i, channel) / static_cast<double>(n);
    block.min_V = std::min(block.min_V, samples(i, channel));
    block.max_V = std::max(block.max_V, samples(i, channel));
  }
  for (py::ssize_t i = 0; i < n; ++i) block.std_V += std::pow(samples(i, channel) - block.mean_V, 2);
  block.std_V = n > 1 ? std::sqrt(block.std_V / static_cast<double>(n - 1)) : kNaN;
  return block;
}

/// Scans x 4 volts, or (volts, codes), or the name of a status: "no_light".
Acquisition AcquisitionOf(const py::object& answer, Time start, bool keep_raw) {
  Acquisition block;
  block.start = start;
  if (py::isinstance<py::str>(answer)) {
    const auto status = ReadingStatusOf(answer.cast<std::string>());
    if (!status) throw BenchError("acquire() of the Python bench: returned an unknown status");
    block.status = *status;
    return block;
  }
  const bool has_codes = py::isinstance<py::tuple>(answer);
  const auto volts = (has_codes ? answer[py::int_(0)] : py::object(answer)).cast<Samples>();
  if (volts.ndim() != 2 || volts.shape(0) < 1 || volts.shape(1) != kChannels)
    throw BenchError("acquire() of the Python bench: expected an array of n_samples x 4 volts");
  block.n_samples = static_cast<int>(volts.shape(0));
  for (int c = 0; c < kChannels; ++c) block.channel[static_cast<std::size_t>(c)] = BlockOf(volts, c);
  if (!has_codes || !keep_raw) return block;
  const auto codes = answer[py::int_(1)].cast<Codes>();
  if (codes.size() != volts.size())
    throw BenchError("acquire() of the Python bench: expected as many codes as volts");
  block.raw.assign(codes.data(), codes.data() + codes.size());
  return block;
}

class Converter : public AdConverter {
 public:
  Converter(const py::object& bench, const twinbench::Clock& clock) : bench_(bench), clock_(clock) {}
  Acquisition Acquire(int n_samples, bool keep_raw) override {
    const Time start = clock_.Now();
    return Asked("acquire",
                 [&] { return AcquisitionOf(bench_.attr("acquire")(n_samples, keep_raw), start, keep_raw); });
  }

 private:
  const py::object& bench_;
  const twinbench::Clock& clock_;
};

class Autocollimator : public twinbench::Autocollimator {
 public:
  explicit Autocollimator(const py::object& bench) : bench_(bench) {}
  AutocollimatorReading Read() override {
    return Asked("autocollimator", [&]() -> AutocollimatorReading {
      const py::object answer = bench_.attr("autocollimator")();
      if (answer.is_none()) return {kNaN, kNaN, ReadingStatus::kMissing};
      const auto [yaw_rad, tilt_rad] = answer.cast<std::pair<double, double>>();
      return {yaw_rad, tilt_rad, ReadingStatus::kOk};
    });
  }

 private:
  const py::object& bench_;
};

class Thermometer : public twinbench::Thermometer {
 public:
  explicit Thermometer(const py::object& bench) : bench_(bench) {}
  double Read_degC() override { return Ask<double>(bench_, "temperature_degC"); }

 private:
  const py::object& bench_;
};

class Goniometer : public twinbench::Goniometer {
 public:
  explicit Goniometer(const py::object& bench) : bench_(bench) {}
  void MoveTo(double yaw_rad, double tilt_rad) override { Ask(bench_, "goniometer", yaw_rad, tilt_rad); }

 private:
  const py::object& bench_;
};

class Fixture : public twinbench::Fixture {
 public:
  explicit Fixture(const py::object& bench) : bench_(bench) {}
  void Mount(int setup, double clamp_rad, double reseat_rad) override {
    Ask(bench_, "mount", setup, clamp_rad, reseat_rad);
  }

 private:
  const py::object& bench_;
};

}  // namespace own

struct OwnRotaryBench::Devices {
  explicit Devices(py::object all) : bench(std::move(all)) {}

  py::object bench;
  own::Clock clock{bench};
  own::Table target{bench, "target"}, reference{bench, "reference"};
  own::Converter adc{bench, clock};
  own::Autocollimator autocollimator{bench};
  own::Thermometer thermometer{bench};
  own::Goniometer goniometer{bench};
  own::Fixture fixture{bench};
};

OwnRotaryBench::OwnRotaryBench(py::object bench) {
  RequireMethods(bench, {"now_s", "wait", "start_move", "settles", "state", "stop", "home", "acquire",
                         "autocollimator", "temperature_degC", "goniometer", "mount"});
  devices_ = std::make_unique<Devices>(std::move(bench));
}

OwnRotaryBench::~OwnRotaryBench() {
  py::gil_scoped_acquire lock;
  devices_.reset();
}

RotaryBench OwnRotaryBench::Bench() {
  Devices& d = *devices_;
  return {d.clock, d.target, d.reference, d.adc, d.autocollimator, d.thermometer, d.goniometer, d.fixture};
}

OwnAngleComparator::OwnAngleComparator(py::object bench) : bench_(std::move(bench)) {
  RequireMethods(bench_, {"take"});
}

OwnAngleComparator::~OwnAngleComparator() {
  py::gil_scoped_acquire lock;
  bench_ = py::object();
}

void OwnAngleComparator::Take(Reading& reading) {
  const double time_s = ToSeconds(reading.time);
  const auto [reference_rad, measured_rad] = Ask<std::pair<double, double>>(
      bench_, "take", time_s, reading.reference_rad, reading.velocity_rad_s, reading.direction);
  reading.reference_rad = reference_rad;
  reading.measured_rad = measured_rad;
}

}  // namespace twinbench::python
