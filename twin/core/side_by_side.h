#pragma once

#include <functional>

namespace twinbench {

/// As many as this machine can run at once.
int ProcessorCount();

/// work(0) to work(count - 1), each once, by so many threads, this one among them. Which thread does which is chance: each writes what
/// no other touches. What one throws is thrown here, once all threads have ended; what was not begun by then is left undone.
void SideBySide(int count, int threads, const std::function<void(int)>& work);

}  // namespace twinbench
