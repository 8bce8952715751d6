#include <fcntl.h>
#include <sys/socket.h>

#include <cstdarg>
#include <cstring>
#include <map>
#include <mutex>

#include "tests/support/comedi_device/card.h"

/// The calls of libc by which libcomedi reaches a card, answered for one path: reading and waiting happen on a real
/// socket, and a failed command shows at its end. Everything else goes to the kernel.
namespace twinbench::test {
namespace {

constexpr const char* kPath = "/dev/comedi0";

std::mutex mutex;

std::map<int, std::shared_ptr<Card>>& Cards() {
  static auto* cards = new std::map<int, std::shared_ptr<Card>>;  // outlives whoever closes late
  return *cards;
}

std::shared_ptr<Card> CardAt(int descriptor) {
  const std::lock_guard lock(mutex);
  const auto found = Cards().find(descriptor);
  return found != Cards().end() ? found->second : nullptr;
}

int OpenCard() {
  std::array<int, 2> pair{};
  if (socketpair(AF_UNIX, SOCK_STREAM, 0, pair.data()) != 0) return -1;
  try {
    auto card = std::make_shared<Card>(pair[0]);
    syscall(SYS_close, pair[1]);
    const std::lock_guard lock(mutex);
    Cards()[pair[0]] = std::move(card);
    return pair[0];
  } catch (const std::exception&) {  // the twin does not answer
    for (const int end : pair) syscall(SYS_close, end);
    errno = ENXIO;
    return -1;
  }
}

int Open(const char* path, int flags, mode_t mode) {
  if (std::strcmp(path, kPath) == 0) return OpenCard();
  return static_cast<int>(syscall(SYS_openat, AT_FDCWD, path, flags, mode));
}

}  // namespace
}  // namespace twinbench::test

extern "C" {

int open(const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(more, mode_t) : 0;
  va_end(more);
  return twinbench::test::Open(path, flags, mode);
}

int open64(const char*, int, ...) __attribute__((alias("open")));

int ioctl(int descriptor, unsigned long request, ...) noexcept {
  va_list more;
  va_start(more, request);
  void* argument = va_arg(more, void*);
  va_end(more);
  const auto card = twinbench::test::CardAt(descriptor);
  if (!card) return static_cast<int>(syscall(SYS_ioctl, descriptor, request, argument));
  int result = -EIO;
  try {
    result = card->Control(static_cast<unsigned>(request), argument);  // libcomedi's came through an int
  } catch (const std::exception&) {                                    // the twin does not answer: the bus does not
  }
  if (result >= 0) return result;
  errno = -result;
  return -1;
}

ssize_t read(int descriptor, void* buffer, size_t size) {
  const ssize_t n = syscall(SYS_read, descriptor, buffer, size);
  if (n != 0) return n;
  const auto card = twinbench::test::CardAt(descriptor);
  if (!card || !card->failed()) return n;
  errno = EPIPE;
  return -1;
}

int close(int descriptor) {
  std::shared_ptr<twinbench::test::Card> card;
  {
    const std::lock_guard lock(twinbench::test::mutex);
    const auto found = twinbench::test::Cards().find(descriptor);
    if (found != twinbench::test::Cards().end()) {
      card = std::move(found->second);
      twinbench::test::Cards().erase(found);
    }
  }
  card.reset();  // stops its command before the descriptor goes
  return static_cast<int>(syscall(SYS_close, descriptor));
}
}
