#pragma once

#include <memory>
#include <stdexcept>
#include <string>

namespace twinbench {

/// What is wrong with somebody's input.
struct InputFault {
  std::string where;     // "file.toml:12", "readings.csv:7" or "--set"
  std::string what;      // was found there
  std::string expected;  // would have been right
};

/// Somebody's file or command line is wrong. `main` prints it and exits with code 2.
class InputError : public std::runtime_error {
 public:
  InputError(const std::string& where, const std::string& what, const std::string& expected);

  const InputFault& fault() const { return *fault_; }

 private:
  std::shared_ptr<const InputFault> fault_;  // for an exception is copied without another
};

/// The world failed: a device, a disk, a table that does not settle. `main` exits with code 1.
class BenchError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Our own mistake: a precondition that a caller inside the program broke.
/// @throws std::logic_error with `message` unless `condition` holds.
inline void Require(bool condition, const char* message) {
  if (!condition) throw std::logic_error(message);
}

}  // namespace twinbench
