#pragma once

#include <istream>
#include <ostream>
#include <string>

#include "twin/core/machine.h"

/// Devices that are a person's hands: they say what to do and wait for Enter.
namespace twinbench::hw {

/// Somebody at a console. Does not own its streams.
class Operator {
 public:
  Operator(std::istream& in, std::ostream& out) : in_(&in), out_(&out) {}
  /// Returns when Enter was pressed.
  /// @throws DeviceFault kStopped at the end of the input, and on "stop".
  void DoAndConfirm(const std::string& device, const std::string& what);

 private:
  std::istream* in_;
  std::ostream* out_;
};

class ConsoleFixture : public Fixture {
 public:
  explicit ConsoleFixture(Operator hands) : hands_(hands) {}
  void Mount(int setup, double clamp_rad, double reseat_rad) override;

 private:
  Operator hands_;
};

class ConsoleMachineFixture : public MachineFixture {
 public:
  explicit ConsoleMachineFixture(Operator hands) : hands_(hands) {}
  void Clear() override;
  void Mount(int setup, const std::string& what) override;

 private:
  Operator hands_;
};

class ConsoleIndexer : public Indexer {
 public:
  explicit ConsoleIndexer(Operator hands) : hands_(hands) {}
  void IndexTo(int tooth, double angle_rad) override;
  bool IsByHand() const override { return true; }

 private:
  Operator hands_;
};

class ConsoleGoniometer : public Goniometer {
 public:
  explicit ConsoleGoniometer(Operator hands) : hands_(hands) {}
  void MoveTo(double yaw_rad, double tilt_rad) override;

 private:
  Operator hands_;
};

}  // namespace twinbench::hw
