#pragma once

#include "twin/core/devices.h"
#include "twin/core/scenario.h"

/// What a backend must bring to be put through the contract of the device interfaces.
namespace twinbench::test {

/// A bench that is up, with whatever keeps it alive.
class LivingBench {
 public:
  virtual ~LivingBench() = default;
  virtual RotaryBench Bench() = 0;
};

/// One backend. `make` sets up a new bench; a real one goes to its rest position.
struct BenchBackend {
  std::string name;  // letters and digits, of the test
  std::function<std::unique_ptr<LivingBench>(const Scenario&)> make;
  bool repeats_its_bits = false;  // a twin or a replay: same scenario, same numbers
  bool always_has_raw = false;    // counts come with every block, asked for or not

  std::string missing = {};  // why it cannot be tried here

  friend void PrintTo(const BenchBackend& backend, std::ostream* out) { *out << backend.name; }
};

/// The twin at its three fidelities, served twins reached as real benches are, and recordings.
std::vector<BenchBackend> Backends();
/// The bench of tests/python/closed_form_bench.py, driven through the package that users have.
BenchBackend PythonBackend();

}  // namespace twinbench::test
