#pragma once

#include <algorithm>
#include <cmath>

#include "twin/core/machine.h"

/// Benches without physics behind the served protocols: what is tried here is what clients say, not what light does.
namespace twinbench::fuzz {

class PlainClock : public Clock {
 public:
  Time Now() const override { return now_; }
  void Wait(Duration duration) override { now_ += duration; }
  void Reset() { now_ = {}; }

 private:
  Time now_{};
};

/// Something that goes at a steady speed to where it was sent.
class PlainAxis {
 public:
  explicit PlainAxis(Clock& clock) : clock_(clock) {}
  void Start(double to) {
    from_ = Place();
    to_ = to;
    began_ = clock_.Now();
  }
  double Place() const {
    const double way = to_ - from_;
    const double gone = kSpeed * ToSeconds(clock_.Now() - began_);
    return gone >= std::abs(way) ? to_ : from_ + std::copysign(gone, way);
  }
  double Target() const { return to_; }
  bool Moves() const { return Place() != to_; }
  bool Settles(Duration within) {
    const double left_s = std::abs(to_ - Place()) / kSpeed;
    const bool arrives = left_s <= ToSeconds(within);
    clock_.Wait(arrives ? std::min(FromSeconds(left_s) + Duration(1), within) : within);
    return !Moves();
  }

 private:
  static constexpr double kSpeed = 0.5;  // rad/s or m/s
  Clock& clock_;
  double from_ = 0.0, to_ = 0.0;
  Time began_{};
};

class PlainTable : public RotaryTable {
 public:
  explicit PlainTable(Clock& clock) : axis_(clock) {}
  void StartMove(double angle_rad) override { axis_.Start(angle_rad); }
  bool Settles(Duration within) override { return axis_.Settles(within); }
  TableState State() override {
    return {axis_.Target(), axis_.Place(), axis_.Moves(), !axis_.Moves(), true, 0, ""};
  }
  void Stop() override { axis_.Start(axis_.Place()); }
  void Home() override { axis_.Start(0.0); }

 private:
  PlainAxis axis_;
};

/// The rotary bench: dark converters, instruments that show zero.
class PlainRotary : public AdConverter, public Autocollimator, public Thermometer, public Goniometer, public Fixture,
                    public Simulation {
 public:
  RotaryBench Bench() { return {clock_, target_, reference_, *this, *this, *this, *this, *this, this}; }

  Acquisition Acquire(int n_samples, bool) override {
    Acquisition taken;
    taken.start = clock_.Now();
    taken.n_samples = n_samples;
    taken.raw.assign(static_cast<std::size_t>(n_samples) * kChannels, 0);
    clock_.Wait(Duration(16'000) * n_samples);
    return taken;
  }
  AutocollimatorReading Read() override { return {0.0, 0.0}; }
  double Read_degC() override { return 20.0; }
  void MoveTo(double, double) override {}
  void Mount(int, double, double) override {}
  void Restart() override { clock_.Reset(); }
  void SetPaced(bool) override {}

 private:
  PlainClock clock_;
  PlainTable target_{clock_}, reference_{clock_};
};

/// Three axes, a multi-tooth table, and an instrument with the columns that it is told.
class PlainMachine : public MachineController,
                     public InstrumentSet,
                     public Indexer,
                     public MachineFixture,
                     public Simulation {
 public:
  MachineBench Bench() { return {clock_, *this, *this, *this, this, this}; }

  const std::vector<MachineAxis>& Axes() const override { return axes_; }
  std::vector<AxisLimits> Travel() override { return std::vector<AxisLimits>(3, {.lower = -1.0, .upper = 1.0}); }
  void StartMove(const std::vector<double>& to, double) override {
    for (std::size_t k = 0; k < to.size(); ++k) place_[k].Start(to[k]);
  }
  void StartArc(const Arc& arc) override { place_[0].Start(arc.centre_m[0]); }
  void StartTurning(std::size_t axis, double speed_rad_s, Duration) override { place_.at(axis).Start(speed_rad_s); }
  void IndexTo(int, double angle_rad) override { place_[2].Start(angle_rad); }
  bool Settles(Duration within) override { return place_[0].Settles(within); }
  std::vector<AxisState> State() override {
    std::vector<AxisState> states;
    for (const PlainAxis& axis : place_)
      states.push_back({axis.Target(), axis.Place(), axis.Moves(), !axis.Moves(), true, 0, ""});
    return states;
  }
  void Stop() override {
    for (PlainAxis& axis : place_) axis.Start(axis.Place());
  }
  void Home() override { Stop(); }
  Reading Read() override {
    Reading reading;
    reading.time = clock_.Now();
    return reading;
  }
  void Arm(int samples, int) override { armed_ = samples; }
  LatchedSamples Latched() override {
    LatchedSamples latched;
    for (; armed_ > 0 && latched.samples.size() < 1000; --armed_) latched.samples.push_back(Read());
    return latched;
  }
  void Clear() override {}
  void Mount(int, const std::string&) override {}
  void Restart() override { clock_.Reset(); }
  void SetPaced(bool) override {}

 private:
  PlainClock clock_;
  std::vector<MachineAxis> axes_ = {{"x", false}, {"y", false}, {"a", true}};
  std::array<PlainAxis, 3> place_{PlainAxis(clock_), PlainAxis(clock_), PlainAxis(clock_)};
  int armed_ = 0;
};

}  // namespace twinbench::fuzz
