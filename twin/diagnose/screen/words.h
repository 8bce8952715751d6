#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

namespace twinbench::diagnose::screen {

/// What a test says: templates of fmt.
struct Words {
  std::string_view test;            // its name
  std::string_view item;            // one of the alternatives that it tries
  std::string_view reading;         // what the loudest means
  std::string_view otherwise = {};  // the same if it deviates the other way
};

/// @throws std::logic_error if no test has this name.
const Words& WordsOf(std::string_view test);

template <typename... Args>
std::string Filled(std::string_view words, const Args&... args) {
  return fmt::format(fmt::runtime(words), args...);
}

template <typename... Args>
std::string ItemOf(std::string_view test, const Args&... args) {
  return Filled(WordsOf(test).item, args...);
}

template <typename... Args>
std::string ReadingOf(std::string_view test, const Args&... args) {
  return Filled(WordsOf(test).reading, args...);
}

/// Of a test that deviates either way.
template <typename... Args>
std::string ReadingBySign(std::string_view test, bool positive, const Args&... args) {
  return Filled(positive ? WordsOf(test).reading : WordsOf(test).otherwise, args...);
}

}  // namespace twinbench::diagnose::screen
