#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace twinbench::optics {

/// Memory of one of several arrays through which loops walk together.
///
/// It begins where a cache line does, so that no register of numbers lies on two. Large arrays begin at different
/// places within their pages: the system hands out whole pages, and the same number of all arrays would compete for
/// the eight lines that the first-level cache has for such addresses.
template <class T>
struct ColumnAllocator {
  using value_type = T;

  std::size_t place = 0;  // of the array among the others

  explicit ColumnAllocator(std::size_t its_place) : place(its_place) {}
  template <class U>
  explicit ColumnAllocator(const ColumnAllocator<U>& other) : place(other.place) {}

  T* allocate(std::size_t n) {
    void* const memory = ::operator new(n * sizeof(T) + Offset(n), kLine);
    return reinterpret_cast<T*>(static_cast<std::byte*>(memory) + Offset(n));
  }
  void deallocate(T* array, std::size_t n) {
    ::operator delete(reinterpret_cast<std::byte*>(array) - Offset(n), kLine);
  }

  bool operator==(const ColumnAllocator&) const = default;

 private:
  static constexpr std::align_val_t kLine{64};
  static constexpr std::size_t kPage = 4096, kStagger = 17 * 64;

  std::size_t Offset(std::size_t n) const { return n * sizeof(T) < kPage ? 0 : place * kStagger % kPage; }
};

/// A vector in such memory.
template <class T>
class Column : public std::vector<T, ColumnAllocator<T>> {
 public:
  explicit Column(std::size_t place) : std::vector<T, ColumnAllocator<T>>(ColumnAllocator<T>(place)) {}
};

}  // namespace twinbench::optics
