#pragma once

#include <set>
#include <string>
#include <vector>

#include "hw_bridge/machine_file.h"

namespace twinbench::hw {

/// Where the devices of a bench are reached; none on a bench without hardware.
std::set<std::string> AddressesOf(const BenchFile& file);
std::set<std::string> AddressesOf(const MachineFile& file);

/// Says on this computer that a program drives the devices at some addresses. The system takes it away when the program
/// ends, however it ends.
class BenchLock {
 public:
  /// @param what  What the program does, for whoever is refused: "measure into runs/monday".
  /// @throws BenchError if another program has one of them: who, since when.
  BenchLock(const std::set<std::string>& addresses, const std::string& what);
  ~BenchLock();
  BenchLock(const BenchLock&) = delete;
  BenchLock& operator=(const BenchLock&) = delete;

 private:
  void Take(const std::string& address, const std::string& who);
  void Release();

  std::vector<int> handles_;
};

}  // namespace twinbench::hw
