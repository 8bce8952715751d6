#pragma once

#include "tests/hw_serve/serving.h"

/// What is said and answered in tests/data/conversations.txt.
namespace twinbench::test {

struct Said {
  std::string port, text;
  std::vector<std::string> answers;
};

struct Conversation {
  std::string name;
  std::vector<Said> turns;
};

inline std::string WithCharacters(std::string text) {
  for (const auto& [written, character] :
       {std::pair{"\\n", "\n"}, {"\\r", "\r"}, {"\\x01", "\x01"}, {"\\x02", "\x02"}})
    for (std::size_t at = text.find(written); at != std::string::npos; at = text.find(written))
      text.replace(at, std::strlen(written), character);
  return text;
}

inline std::vector<Conversation> Conversations() {
  std::vector<Conversation> all;
  std::ifstream file(TWINBENCH_TEST_DATA "/conversations.txt");
  for (std::string line; std::getline(file, line);) {
    const std::size_t prompt = line.find("> ");
    if (line.starts_with("## "))
      all.push_back({line.substr(3), {}});
    else if (line.empty() || line.starts_with("#"))
      continue;
    else if (prompt < 6)
      all.back().turns.push_back({line.substr(0, prompt), WithCharacters(line.substr(prompt + 2)), {}});
    else
      all.back().turns.back().answers.push_back(line);
  }
  return all;
}

}  // namespace twinbench::test
