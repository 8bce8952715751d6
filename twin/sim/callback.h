#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>

namespace twinbench::sim {

/// A move-only `void()` to be called once. Captures of up to 48 bytes that move without throwing live inside the
/// object, larger ones on the heap.
class Callback {
 public:
  static constexpr std::size_t kInside = 48;

  Callback() = default;
  template <typename F>
  requires(!std::is_same_v<std::remove_cvref_t<F>, Callback> &&
           std::is_invocable_v<std::remove_cvref_t<F>&>) explicit Callback(F&& f) {
    using Stored = std::remove_cvref_t<F>;
    if constexpr (FitsInside<Stored>()) {
      ::new (static_cast<void*>(storage_)) Stored(std::forward<F>(f));
      operations_ = &kOperations<Stored>;
    } else {
      *this = Callback(OnHeap<Stored>{std::make_unique<Stored>(std::forward<F>(f))});
    }
  }
  Callback(Callback&& other) noexcept { TakeFrom(other); }
  Callback& operator=(Callback&& other) noexcept {
    if (this == &other) return *this;
    Clear();
    TakeFrom(other);
    return *this;
  }
  ~Callback() { Clear(); }

  void operator()() { operations_->call(storage_); }
  explicit operator bool() const { return operations_ != nullptr; }

  template <typename F>
  static constexpr bool FitsInside() {
    return sizeof(F) <= kInside && alignof(F) <= alignof(std::max_align_t) &&
           std::is_nothrow_move_constructible_v<F>;
  }

 private:
  template <typename F>
  struct OnHeap {
    std::unique_ptr<F> f;
    void operator()() { std::invoke(*f); }
  };
  struct Operations {
    void (*call)(void* object);
    void (*move)(void* from, void* to) noexcept;  // leaves nothing behind at `from`
    void (*destroy)(void* object) noexcept;
  };
  template <typename F>
  static constexpr Operations kOperations = {
      [](void* object) { static_cast<void>(std::invoke(*static_cast<F*>(object))); },
      [](void* from, void* to) noexcept {
        ::new (to) F(std::move(*static_cast<F*>(from)));
        static_cast<F*>(from)->~F();
      },
      [](void* object) noexcept { static_cast<F*>(object)->~F(); }};

  void TakeFrom(Callback& other) noexcept {
    if (!other.operations_) return;
    other.operations_->move(other.storage_, storage_);
    operations_ = std::exchange(other.operations_, nullptr);
  }
  void Clear() noexcept {
    if (operations_) std::exchange(operations_, nullptr)->destroy(storage_);
  }

  alignas(std::max_align_t) std::byte storage_[kInside];
  const Operations* operations_ = nullptr;
};

}  // namespace twinbench::sim
