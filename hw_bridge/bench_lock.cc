#include "hw_bridge/bench_lock.h"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <ctime>
#include <filesystem>

#include "twin/core/errors.h"

namespace twinbench::hw {
namespace {

constexpr mode_t kForEverybody = 0666;

void AddAddress(std::set<std::string>& addresses, const ControlSettings& settings) {
  if (!settings.address.empty()) addresses.insert(settings.address);
}

/// FNV-1a: names of files may not hold what addresses do.
std::uint64_t HashOf(const std::string& text) {
  std::uint64_t hash = 14695981039346656037u;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211u;
  return hash;
}

/// Where programs of all users meet.
std::string LockFile(const std::string& address) {
  const char* const folder = access("/run/lock", W_OK) == 0 ? "/run/lock" : "/tmp";
  return fmt::format("{}/twinbench-{:016x}.lock", folder, HashOf(address));
}

/// The file of another user can be locked too, though not written on.
int OpenForAll(const std::string& path) {
  int handle = open(path.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW);
  if (handle < 0 && errno == ENOENT) {
    handle = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, kForEverybody);
    if (handle >= 0) static_cast<void>(fchmod(handle, kForEverybody));
  }
  return handle >= 0 ? handle : open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
}

std::string WhoHas(int handle) {
  char text[256];
  const ssize_t read = pread(handle, text, sizeof text, 0);
  return read > 0 ? std::string(text, static_cast<std::size_t>(read)) : "another program";
}

void WriteWho(int handle, const std::string& who) {
  if (ftruncate(handle, 0) != 0) return;  // another user's file: locked, but unnamed
  static_cast<void>(pwrite(handle, who.data(), who.size(), 0) < 0);
}

}  // namespace

std::set<std::string> AddressesOf(const BenchFile& file) {
  std::set<std::string> addresses;
  if (file.kind != "hardware") return addresses;
  addresses.insert(file.adc.kind == "iio" ? file.adc.uri + " " + file.adc.device : file.adc.device);
  for (const ControlSettings* settings : {&file.target, &file.reference, &file.autocollimator, &file.thermometer,
                                          &file.goniometer, &file.fixture, &file.clock})
    AddAddress(addresses, *settings);
  return addresses;
}

std::set<std::string> AddressesOf(const MachineFile& file) {
  std::set<std::string> addresses;
  if (file.kind != "hardware") return addresses;
  for (const ControlSettings* settings : {&file.machine, &file.indexer, &file.fixture, &file.clock})
    AddAddress(addresses, *settings);
  for (const InstrumentSettings& instrument : file.instruments) {
    AddAddress(addresses, instrument.connection);
    if (instrument.connection.kind == "iio") addresses.insert(instrument.uri + " " + instrument.device);
    if (instrument.connection.kind == "comedi") addresses.insert(instrument.device);
  }
  return addresses;
}

BenchLock::BenchLock(const std::set<std::string>& addresses, const std::string& what) {
  const std::string who =
      fmt::format("{} (process {}, since {:%FT%TZ})", what, getpid(), fmt::gmtime(std::time(nullptr)));
  try {
    for (const std::string& address : addresses) Take(address, who);
  } catch (...) {
    Release();
    throw;
  }
}

BenchLock::~BenchLock() {
  Release();
}

void BenchLock::Take(const std::string& address, const std::string& who) {
  const std::string path = LockFile(address);
  const int handle = OpenForAll(path);
  if (handle < 0) throw BenchError(fmt::format("{}: cannot be opened: {}", path, std::strerror(errno)));
  handles_.push_back(handle);
  if (flock(handle, LOCK_EX | LOCK_NB) != 0)
    throw BenchError(fmt::format("the devices at {} are driven by another program: {}", address, WhoHas(handle)));
  WriteWho(handle, who);
}

void BenchLock::Release() {
  for (const int handle : handles_) close(handle);
  handles_.clear();
}

}  // namespace twinbench::hw
