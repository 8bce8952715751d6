// Stands between a program and the C library for all files below TWINBENCH_DISK_ROOT.
//
//   TWINBENCH_DISK_LOG     file that gets every change of those files in order (see write_log.h)
//   TWINBENCH_DISK_ROOM_B  bytes by which they may grow before the disk is full
//   TWINBENCH_DISK_TELLS   "0": the file system does not tell how full it is (a quota)
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <cerrno>
#include <cstdarg>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>
#include <string>

namespace {

template <class Function>
Function* Real(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

struct State {
  std::recursive_mutex mutex;
  std::string root;
  int log = -1;
  std::int64_t room_B = INT64_MAX;
  bool tells = true;
  std::map<int, std::string> paths;  // of open files
};

/// Never destroyed: files are closed until the very end of the process.
State& TheState() {
  static State* state = [] {
    auto* made = new State;
    if (const char* root = std::getenv("TWINBENCH_DISK_ROOT")) made->root = root;
    if (const char* room = std::getenv("TWINBENCH_DISK_ROOM_B")) made->room_B = std::atoll(room);
    if (const char* tells = std::getenv("TWINBENCH_DISK_TELLS")) made->tells = std::strcmp(tells, "0") != 0;
    if (const char* log = std::getenv("TWINBENCH_DISK_LOG"))
      made->log = Real<int(const char*, int, ...)>("open")(log, O_WRONLY | O_CREAT | O_APPEND, 0600);
    return made;
  }();
  return *state;
}

std::string Absolute(const char* path) {
  if (path[0] == '/') return path;
  char folder[4096];
  return getcwd(folder, sizeof folder) ? std::string(folder) + "/" + path : path;
}

bool IsOurs(const std::string& path) {
  const State& state = TheState();
  return !state.root.empty() && path.compare(0, state.root.size(), state.root) == 0;
}

/// One change: what, of which file, where, and the bytes.
void Log(char what, const std::string& path, std::uint64_t at, const void* data, std::uint64_t size) {
  const State& state = TheState();
  if (state.log < 0) return;
  const auto put = [&](const void* bytes, std::size_t n) {
    if (Real<ssize_t(int, const void*, size_t)>("write")(state.log, bytes, n) != static_cast<ssize_t>(n))
      std::abort();
  };
  const std::uint32_t length = static_cast<std::uint32_t>(path.size());
  put(&what, 1);
  put(&length, sizeof length);
  put(path.data(), path.size());
  put(&at, sizeof at);
  put(&size, sizeof size);
  if (size > 0) put(data, size);
}

int Opened(int handle, const char* path, int flags, bool was_there) {
  State& state = TheState();
  const std::lock_guard lock(state.mutex);
  const std::string absolute = Absolute(path);
  if (handle < 0 || !IsOurs(absolute)) return handle;
  state.paths[handle] = absolute;
  if (!was_there) Log('c', absolute, 0, nullptr, 0);
  if ((flags & O_TRUNC) != 0) Log('t', absolute, 0, nullptr, 0);
  return handle;
}

std::string PathOf(int handle) {
  State& state = TheState();
  const auto found = state.paths.find(handle);
  return found == state.paths.end() ? "" : found->second;
}

/// @return whether the file may grow to `end`; the disk is full otherwise.
bool MakesRoom(int handle, std::uint64_t end) {
  State& state = TheState();
  struct stat now {};
  if (state.room_B == INT64_MAX || fstat(handle, &now) != 0) return true;
  const std::int64_t growth_B = static_cast<std::int64_t>(end) - now.st_size;
  if (growth_B <= 0) return true;
  if (growth_B > state.room_B) return false;
  state.room_B -= growth_B;
  return true;
}

ssize_t WriteAt(int handle, const void* data, size_t size, off_t at) {
  State& state = TheState();
  const std::lock_guard lock(state.mutex);
  const std::string path = PathOf(handle);
  if (!path.empty() && !MakesRoom(handle, static_cast<std::uint64_t>(at) + size)) {
    errno = ENOSPC;
    return -1;
  }
  const ssize_t done = Real<ssize_t(int, const void*, size_t, off_t)>("pwrite64")(handle, data, size, at);
  if (done > 0 && !path.empty())
    Log('w', path, static_cast<std::uint64_t>(at), data, static_cast<std::uint64_t>(done));
  return done;
}

int Synced(int result, int handle) {
  const std::lock_guard lock(TheState().mutex);
  const std::string path = PathOf(handle);
  if (result == 0 && !path.empty()) Log('s', path, 0, nullptr, 0);
  return result;
}

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(more, mode_t) : 0;
  va_end(more);
  const bool was_there = access(path, F_OK) == 0;
  return Opened(Real<int(const char*, int, ...)>("open")(path, flags, mode), path, flags, was_there);
}

int open64(const char* path, int flags, ...) __attribute__((alias("open")));

int close(int handle) {
  {
    const std::lock_guard lock(TheState().mutex);
    TheState().paths.erase(handle);
  }
  return Real<int(int)>("close")(handle);
}

ssize_t pwrite(int handle, const void* data, size_t size, off_t at) {
  return WriteAt(handle, data, size, at);
}

ssize_t pwrite64(int handle, const void* data, size_t size, off_t at) __attribute__((alias("pwrite")));

ssize_t write(int handle, const void* data, size_t size) {
  State& state = TheState();
  const std::lock_guard lock(state.mutex);
  if (PathOf(handle).empty()) return Real<ssize_t(int, const void*, size_t)>("write")(handle, data, size);
  const bool appends = (fcntl(handle, F_GETFL) & O_APPEND) != 0;
  const off_t at = lseek(handle, 0, appends ? SEEK_END : SEEK_CUR);
  const ssize_t done = WriteAt(handle, data, size, at);
  if (done > 0) lseek(handle, at + done, SEEK_SET);
  return done;
}

int ftruncate64(int handle, off_t size) {
  const std::lock_guard lock(TheState().mutex);
  const std::string path = PathOf(handle);
  const int result = Real<int(int, off_t)>("ftruncate64")(handle, size);
  if (result == 0 && !path.empty()) Log('t', path, static_cast<std::uint64_t>(size), nullptr, 0);
  return result;
}

int ftruncate(int handle, off_t size) {
  return ftruncate64(handle, size);
}

int fsync(int handle) {
  return Synced(Real<int(int)>("fsync")(handle), handle);
}

int fdatasync(int handle) {
  return Synced(Real<int(int)>("fdatasync")(handle), handle);
}

int rename(const char* from, const char* to) {
  const std::lock_guard lock(TheState().mutex);
  const int result = Real<int(const char*, const char*)>("rename")(from, to);
  const std::string target = Absolute(to);
  if (result == 0 && IsOurs(target)) Log('r', Absolute(from), 0, target.data(), target.size());
  return result;
}

int unlink(const char* path) {
  const std::lock_guard lock(TheState().mutex);
  const int result = Real<int(const char*)>("unlink")(path);
  if (result == 0 && IsOurs(Absolute(path))) Log('u', Absolute(path), 0, nullptr, 0);
  return result;
}

int statvfs64(const char* path, struct statvfs64* disk) {
  const std::lock_guard lock(TheState().mutex);
  const int result = Real<int(const char*, struct statvfs64*)>("statvfs64")(path, disk);
  const State& state = TheState();
  if (result == 0 && state.room_B != INT64_MAX && state.tells && IsOurs(Absolute(path)))
    disk->f_bavail = static_cast<fsblkcnt_t>(state.room_B) / disk->f_frsize;
  return result;
}

int statvfs(const char* path, struct statvfs* disk) {
  return statvfs64(path, reinterpret_cast<struct statvfs64*>(disk));
}

}  // extern "C"
